#include "logs/convert/ardupilot_gps.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "base/median.hpp"
#include "base/units.hpp"
#include "geo/wgs84.hpp"

namespace fathom::logs {
namespace {

constexpr double kNoAltitude_m = -2.1e7;  // -2^31 cm
constexpr std::int64_t kTogether_us = 50'000;

GpsFix ardupilot_fix(double status) {
  if (status == 2.0) return GpsFix::fix_2d;
  if (status == 3.0) return GpsFix::fix_3d;
  if (status == 4.0) return GpsFix::differential;
  if (status == 5.0) return GpsFix::rtk_float;
  if (status == 6.0) return GpsFix::rtk_fixed;
  if (status == 7.0) return GpsFix::fix_3d;        // a static base
  if (status == 8.0) return GpsFix::differential;  // precise point positioning
  return GpsFix::none;
}

// Seconds that GPS is ahead of UTC, from these GPS weeks and days on.
DurationNs leap_seconds(TimeNs gps_ns) {
  struct Since {
    CivilTime day;
    int seconds;
  };
  static const std::array<Since, 5> kSince{
      {{{2006, 1, 1}, 14}, {{2009, 1, 1}, 15}, {{2012, 7, 1}, 16}, {{2015, 7, 1}, 17}, {{2017, 1, 1}, 18}}};
  int seconds = 13;
  for (const Since& since : kSince)
    if (gps_ns >= *from_civil(since.day) + since.seconds * kNsPerSecond) seconds = since.seconds;
  return seconds * kNsPerSecond;
}

/// The row of GPA that was logged with a row of GPS.
class Accuracies {
 public:
  Accuracies(const Log& log, unsigned instance) {
    for (const Series* one : log.of("GPA"))
      if (one->instance == instance) series_ = one;
    if (series_ == nullptr) return;
    horizontal_ = series_->find("HAcc");
    vertical_ = series_->find("VAcc");
    speed_ = series_->find("SAcc");
    has_vertical_ = series_->find("VV");
    yaw_ = series_->find("YAcc");
    ellipsoid_ = series_->find("AEl");
  }
  // Times never go back.
  bool go_to(std::int64_t t_us) {
    if (series_ == nullptr) return false;
    while (row_ < series_->rows() && series_->t_us[row_] < t_us) ++row_;
    return row_ < series_->rows() && series_->t_us[row_] - t_us <= kTogether_us;
  }
  [[nodiscard]] double horizontal_m() const { return positive(series_->at(row_, horizontal_)); }
  [[nodiscard]] double vertical_m() const { return positive(series_->at(row_, vertical_)); }
  [[nodiscard]] double speed_m_s() const { return positive(series_->at(row_, speed_)); }
  [[nodiscard]] double yaw_deg() const { return positive(series_->at(row_, yaw_)); }
  [[nodiscard]] bool has_vertical_velocity() const {
    return !has_vertical_ || series_->at(row_, *has_vertical_) != 0.0;
  }
  [[nodiscard]] double ellipsoid_m() const {
    const double altitude_m = series_->at(row_, ellipsoid_);
    return altitude_m > kNoAltitude_m ? altitude_m : kUnknown;
  }

 private:
  const Series* series_ = nullptr;
  std::size_t row_ = 0;
  std::optional<std::size_t> horizontal_, vertical_, speed_, has_vertical_, yaw_, ellipsoid_;
};

void place(const Series& series, std::size_t row, GpsSample& sample) {
  const double latitude_deg = series.at(row, series.find("Lat"));
  const double longitude_deg = series.at(row, series.find("Lng"));
  if (std::abs(latitude_deg) <= 90.0 && std::abs(longitude_deg) <= 180.0) {
    sample.latitude_rad = latitude_deg * kRadPerDeg;
    sample.longitude_rad = longitude_deg * kRadPerDeg;
  }
  sample.altitude_msl_m = series.at(row, series.find("Alt"));
  sample.altitude_m = sample.altitude_msl_m;
}

void convert(const Log& log, const Series& series, const Clock& clock, Vehicle& out) {
  const auto status = series.find("Status");
  const auto speed = series.find("Spd");
  const auto course = series.find("GCrs");
  const auto down = series.find("VZ");
  const auto count = series.find("NSats");
  const auto yaw = series.find("Yaw");
  Accuracies accuracies(log, series.instance);
  auto& samples = out.data.of<GpsSample>();
  auto& headings = out.data.of<HeadingSample>();
  std::size_t ellipsoidal = 0;
  for (std::size_t row = 0; row < series.rows(); ++row) {
    GpsSample& sample = samples.emplace_back();
    sample.header = clock.header(0, series.t_us[row]);
    sample.fix = ardupilot_fix(series.at(row, status));
    place(series, row, sample);
    const double course_rad = series.at(row, course) * kRadPerDeg;
    const double speed_m_s = series.at(row, speed);
    sample.velocity_N_m_s = {speed_m_s * std::cos(course_rad), speed_m_s * std::sin(course_rad),
                             series.at(row, down)};
    sample.course_rad = course_rad;
    sample.hdop = series.at(row, series.find("HDop"));
    const double satellites = series.at(row, count);
    if (satellites >= 0.0 && satellites < 255.0) sample.satellites = static_cast<std::int32_t>(satellites);
    if (!accuracies.go_to(series.t_us[row])) continue;
    sample.position_sigma_N_m = {accuracies.horizontal_m(), accuracies.horizontal_m(),
                                 accuracies.vertical_m()};
    sample.velocity_sigma_N_m_s.fill(accuracies.speed_m_s());
    if (!accuracies.has_vertical_velocity()) sample.velocity_N_m_s[2] = kUnknown;
    if (known(accuracies.ellipsoid_m())) {
      sample.altitude_m = accuracies.ellipsoid_m();
      ++ellipsoidal;
    }
    if (yaw && known(accuracies.yaw_deg())) {
      HeadingSample& heading = headings.emplace_back();
      heading.header = sample.header;
      heading.heading_rad = geo::wrap_two_pi(series.at(row, *yaw) * kRadPerDeg);
      heading.sigma_rad = accuracies.yaw_deg() * kRadPerDeg;
    }
  }
  if (ellipsoidal == 0) {
    out.notes.push_back("gps: " + series.label() +
                        " has no altitude above the ellipsoid; alt_m is above mean sea level");
  } else if (ellipsoidal < samples.size()) {
    // One scale in one file: where it is not known, it is left unknown.
    for (GpsSample& sample : samples)
      if (sample.altitude_m == sample.altitude_msl_m) sample.altitude_m = kUnknown;
  }
  settle(samples, "gps", out);
  settle(headings, "heading", out);
  if (!headings.empty()) out.sources["heading"] = series.label();
}

}  // namespace

std::optional<TimeNs> ardupilot_utc_of_start(const Log& log) {
  std::vector<double> starts_us;
  for (const Series* one : log.of("GPS")) {
    const auto week = one->find_any({"GWk", "Week"});
    const auto ms = one->find_any({"GMS", "TimeMS"});
    const auto status = one->find("Status");
    for (std::size_t row = 0; week && ms && row < one->rows(); ++row) {
      const double weeks = one->at(row, *week);
      const double since_ms = one->at(row, *ms);
      if (!(weeks > 1000.0 && weeks < 10000.0) || !(since_ms >= 0.0 && since_ms <= 604'800'000.0) ||
          !(one->at(row, status) >= 3.0))
        continue;
      const TimeNs gps_ns = *from_civil({1980, 1, 6}) + static_cast<TimeNs>(weeks) * 604'800 * kNsPerSecond +
                            static_cast<TimeNs>(since_ms) * kNsPerMillisecond;
      const std::int64_t utc_us = (gps_ns - leap_seconds(gps_ns)) / 1000;
      starts_us.push_back(static_cast<double>(utc_us - one->t_us[row]));
    }
    if (!starts_us.empty()) break;
  }
  const double start_us = median(std::move(starts_us));
  if (!known(start_us)) return std::nullopt;
  return static_cast<TimeNs>(std::llround(start_us)) * 1000;
}

void ardupilot_gps(const Log& log, const Clock& clock, const ConvertOptions& options, Vehicle& out) {
  std::vector<Candidate> ways;
  for (const Series* one : log.of("GPS")) {
    if (!one->find("Lat") || !one->find("Lng")) continue;
    ways.push_back({one->label(), one, [=, &log, &clock, &out] { convert(log, *one, clock, out); }});
  }
  make_best("gps", ways, false, options, out);
}

}  // namespace fathom::logs

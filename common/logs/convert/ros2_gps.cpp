#include <algorithm>
#include <cmath>

#include "base/median.hpp"
#include "base/units.hpp"
#include "base/unknown.hpp"
#include "logs/convert/ros2_parts.hpp"

namespace fathom::logs {
namespace {

/// A velocity belongs to a fix that is no further away: at 1 m/s² it has changed by 2 cm/s.
constexpr TimeNs kTogether_ns = 20 * kNsPerMillisecond;
constexpr double kMostlyTogether = 0.8;

GpsFix ros2_fix(double status) {
  if (status == 0.0) return GpsFix::fix_3d;
  if (status == 1.0 || status == 2.0) return GpsFix::differential;
  return GpsFix::none;
}

void convert(const Series& series, const Ros2Clock& clock, std::vector<GpsSample>& samples) {
  const auto latitude = series.find("latitude");
  const auto longitude = series.find("longitude");
  const auto altitude = series.find("altitude");
  const auto status = series.find("status.status");
  const auto type = series.find("position_covariance_type");
  const std::array<std::optional<std::size_t>, 3> variance_ENU{series.find("position_covariance[0]"),
                                                               series.find("position_covariance[4]"),
                                                               series.find("position_covariance[8]")};
  for (std::size_t row = 0; row < series.rows(); ++row) {
    const auto header = clock.header(series, row);
    if (!header) continue;
    GpsSample& sample = samples.emplace_back();
    sample.header = *header;
    sample.fix = ros2_fix(series.at(row, status));
    const double latitude_deg = series.at(row, latitude);
    const double longitude_deg = series.at(row, longitude);
    if (std::abs(latitude_deg) <= 90.0 && std::abs(longitude_deg) <= 180.0) {
      sample.latitude_rad = latitude_deg * kRadPerDeg;
      sample.longitude_rad = longitude_deg * kRadPerDeg;
      sample.altitude_m = series.at(row, altitude);
    }
    if (!(series.at(row, type) > 0.0)) continue;  // 0: unknown
    sample.position_sigma_N_m = {sigma_of(series.at(row, variance_ENU[1])),
                                 sigma_of(series.at(row, variance_ENU[0])),
                                 sigma_of(series.at(row, variance_ENU[2]))};
  }
}

// For each sample the row of the twist that is nearest to it, or none near enough.
std::vector<std::optional<std::size_t>> pairs(const std::vector<GpsSample>& samples, const Series& twist,
                                              const Ros2Clock& clock) {
  std::vector<std::pair<TimeNs, std::size_t>> rows;
  for (std::size_t row = 0; row < twist.rows(); ++row) {
    if (const auto header = clock.header(twist, row)) rows.emplace_back(header->stamp_ns, row);
  }
  std::sort(rows.begin(), rows.end());
  std::vector<std::optional<std::size_t>> out;
  for (const GpsSample& sample : samples) {
    const TimeNs stamp = sample.header.stamp_ns;
    auto& one = out.emplace_back();
    const auto after = std::lower_bound(rows.begin(), rows.end(), std::pair(stamp, std::size_t{0}));
    TimeNs best_ns = kTogether_ns + 1;
    for (auto near : {after, after == rows.begin() ? after : after - 1}) {
      if (near == rows.end() || std::abs(near->first - stamp) >= best_ns) continue;
      best_ns = std::abs(near->first - stamp);
      one = near->second;
    }
  }
  return out;
}

// Gives each fix the velocity of its instant. Returns how many got one.
std::size_t attach(const Twist& twist, const Ros2Clock& clock, bool ned, std::vector<GpsSample>& samples) {
  const Series& series = *twist.series;
  // A receiver that gives speed and course has no vertical velocity, and its driver writes zero.
  bool vertical = false;
  for (std::size_t row = 0; row < series.rows(); ++row) vertical |= series.at(row, twist.linear[2]) != 0.0;
  const auto rows = pairs(samples, series, clock);
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!rows[i]) continue;
    ++count;
    const Eigen::Vector3d v = vector_at(series, *rows[i], twist.linear);
    samples[i].velocity_N_m_s = ned ? std::array{v.x(), v.y(), v.z()} : std::array{v.y(), v.x(), -v.z()};
    if (!vertical) samples[i].velocity_N_m_s[2] = kUnknown;
    // The driver names the antenna's frame, and means east-north-up.
    if (!twist.variance) continue;
    std::array<double, 3> sigma{};
    for (std::size_t k = 0; k < 3; ++k) sigma[k] = sigma_of(series.at(*rows[i], (*twist.variance)[k]));
    samples[i].velocity_sigma_N_m_s = ned ? sigma : std::array{sigma[1], sigma[0], sigma[2]};
  }
  return count;
}

// The twist of the receiver: of the fixes' frame, or at their instants.
const Series* velocity_of(const Log& log, const Series& fixes, const Ros2Clock& clock,
                          const std::vector<GpsSample>& samples, const std::string& asked) {
  std::vector<const Series*> all;
  for (const char* type : {"geometry_msgs/TwistWithCovarianceStamped", "geometry_msgs/TwistStamped"})
    for (const Series* one : of_type(log, type))
      if (twist_of(*one)) all.push_back(one);
  std::string have;
  for (const Series* one : all) {
    const std::string label = ros2_label(log, *one);
    have += (have.empty() ? "" : ", ") + label;
    if (!asked.empty() && (label == asked || one->label() == asked)) return one;
  }
  if (!asked.empty()) {
    throw LogError("gps_velocity: the log has no " + asked + ", expected " +
                   (have.empty() ? "none: it has no twist" : "one of " + have));
  }
  for (const Series* one : all)
    if (!fixes.frame.empty() && one->frame == fixes.frame) return one;
  for (const Series* one : all) {
    const auto rows = pairs(samples, *one, clock);
    const auto together =
        std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.has_value(); });
    // At the rate of the fixes: one that is far faster is always near.
    if (static_cast<double>(together) >= kMostlyTogether * static_cast<double>(samples.size()) &&
        static_cast<double>(one->rows()) <= 1.5 * static_cast<double>(samples.size()))
      return one;
  }
  return nullptr;
}

}  // namespace

const Series* ros2_gps(const Log& log, const Ros2Clock& clock, const ConvertOptions& options, Vehicle& out) {
  auto& samples = out.data.of<GpsSample>();
  const Series* fixes = nullptr;
  std::vector<Candidate> ways;
  for (const Series* one : of_type(log, "sensor_msgs/NavSatFix")) {
    if (!one->find("latitude") || !one->find("longitude")) continue;
    ways.push_back({ros2_label(log, *one), one, [one, &fixes, &clock, &samples] {
                      fixes = one;
                      convert(*one, clock, samples);
                    }});
  }
  make_best("gps", ways, false, options, out);
  if (fixes == nullptr) return nullptr;
  const auto asked = options.choice.find("gps_velocity");
  const Series* velocity =
      velocity_of(log, *fixes, clock, samples, asked == options.choice.end() ? "" : asked->second);
  if (velocity != nullptr) {
    const auto axes = options.ros2.axes.find(velocity->topic);
    const bool ned = axes != options.ros2.axes.end() && axes->second == Ros2Options::Axes::frd;
    const std::size_t count = attach(*twist_of(*velocity), clock, ned, samples);
    out.notes.push_back("gps: velocity of " + std::to_string(count) + " of " +
                        std::to_string(samples.size()) + " fixes from " + ros2_label(log, *velocity) +
                        (ned ? ", north-east-down" : ", east-north-up") + ", within 20 ms");
  } else {
    out.notes.push_back("gps: no velocity: no twist has the frame or the instants of " + out.sources["gps"]);
  }
  settle(samples, "gps", out);
  return velocity;
}

}  // namespace fathom::logs

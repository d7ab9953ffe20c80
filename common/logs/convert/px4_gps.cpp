#include "logs/convert/px4_gps.hpp"

#include <cmath>
#include <utility>

#include "base/median.hpp"
#include "base/units.hpp"
#include "geo/wgs84.hpp"

namespace fathom::logs {
namespace {

constexpr double kYear2001_us = 978'307'200e6;

GpsFix px4_fix(double code) {
  if (code == 2.0) return GpsFix::fix_2d;
  if (code == 3.0) return GpsFix::fix_3d;
  if (code == 4.0) return GpsFix::differential;
  if (code == 5.0) return GpsFix::rtk_float;
  if (code == 6.0) return GpsFix::rtk_fixed;
  if (code == 8.0) return GpsFix::dead_reckoning;
  return GpsFix::none;
}

// The columns of vehicle_gps_position and sensor_gps of all years. Until 2023 positions were integers.
struct Columns {
  explicit Columns(const Series& s)
      : latitude(s.find_any({"latitude_deg", "lat"})),
        longitude(s.find_any({"longitude_deg", "lon"})),
        msl(s.find_any({"altitude_msl_m", "alt"})),
        ellipsoid(s.find_any({"altitude_ellipsoid_m", "alt_ellipsoid"})),
        degrees(s.find("latitude_deg") ? 1.0 : 1e-7),
        metres(s.find("altitude_msl_m") ? 1.0 : 1e-3),
        fix(s.find("fix_type")),
        eph(s.find("eph")),
        epv(s.find("epv")),
        speed_sigma(s.find("s_variance_m_s")),  // a standard deviation, whatever it is called
        north(s.find("vel_n_m_s")),
        east(s.find("vel_e_m_s")),
        down(s.find("vel_d_m_s")),
        velocity_valid(s.find("vel_ned_valid")),
        satellites(s.find("satellites_used")),
        hdop(s.find("hdop")),
        course(s.find("cog_rad")),
        heading(s.find("heading")),
        heading_sigma(s.find("heading_accuracy")),
        valid_us(s.find("timestamp_sample")) {}

  using Place = std::optional<std::size_t>;
  Place latitude, longitude, msl, ellipsoid;
  double degrees, metres;
  Place fix, eph, epv, speed_sigma, north, east, down, velocity_valid, satellites, hdop, course, heading,
      heading_sigma, valid_us;
};

// Some drivers leave the ellipsoidal altitude at zero.
bool has_ellipsoid(const Series& series, const Columns& c) {
  if (!c.ellipsoid) return false;
  for (std::size_t row = 0; row < series.rows(); ++row)
    if (series.at(row, *c.ellipsoid) != 0.0 && std::isfinite(series.at(row, *c.ellipsoid))) return true;
  return false;
}

void convert(const Series& series, const Clock& clock, Vehicle& out) {
  const Columns c(series);
  const bool ellipsoid = has_ellipsoid(series, c);
  if (!ellipsoid) {
    out.notes.push_back("gps: " + series.label() +
                        " has no altitude above the ellipsoid; alt_m is above mean sea level");
  }
  auto& samples = out.data.of<GpsSample>();
  auto& headings = out.data.of<HeadingSample>();
  for (std::size_t row = 0; row < series.rows(); ++row) {
    const double valid_us = series.at(row, c.valid_us);
    GpsSample& sample = samples.emplace_back();
    sample.header = clock.header(whole_us(valid_us), series.t_us[row]);
    sample.fix = px4_fix(series.at(row, c.fix));
    const double latitude_deg = series.at(row, c.latitude) * c.degrees;
    const double longitude_deg = series.at(row, c.longitude) * c.degrees;
    if (std::abs(latitude_deg) <= 90.0 && std::abs(longitude_deg) <= 180.0) {
      sample.latitude_rad = latitude_deg * kRadPerDeg;
      sample.longitude_rad = longitude_deg * kRadPerDeg;
    }
    sample.altitude_msl_m = series.at(row, c.msl) * c.metres;
    sample.altitude_m = ellipsoid ? series.at(row, c.ellipsoid) * c.metres : sample.altitude_msl_m;
    const double eph_m = positive(series.at(row, c.eph));
    sample.position_sigma_N_m = {eph_m, eph_m, positive(series.at(row, c.epv))};
    if (!c.velocity_valid || series.at(row, *c.velocity_valid) != 0.0) {
      sample.velocity_N_m_s = {series.at(row, c.north), series.at(row, c.east), series.at(row, c.down)};
      sample.velocity_sigma_N_m_s.fill(positive(series.at(row, c.speed_sigma)));
    }
    const double satellites = series.at(row, c.satellites);
    if (satellites >= 0.0 && satellites < 255.0) sample.satellites = static_cast<std::int32_t>(satellites);
    sample.hdop = series.at(row, c.hdop);
    sample.course_rad = series.at(row, c.course);
    if (const double heading_rad = series.at(row, c.heading); c.heading && std::isfinite(heading_rad)) {
      HeadingSample& heading = headings.emplace_back();
      heading.header = sample.header;
      heading.heading_rad = geo::wrap_two_pi(heading_rad);
      heading.sigma_rad = positive(series.at(row, c.heading_sigma));
    }
  }
  settle(samples, "gps", out);
  settle(headings, "heading", out);
  if (!headings.empty()) out.sources["heading"] = series.label();
}

}  // namespace

std::optional<TimeNs> px4_utc_of_start(const Log& log) {
  std::vector<double> starts_us;
  for (const char* topic : {"vehicle_gps_position", "sensor_gps"}) {
    for (const Series* one : log.of(topic)) {
      const auto utc = one->find("time_utc_usec");
      const auto relative = one->find("timestamp_time_relative");
      for (std::size_t row = 0; utc && row < one->rows(); ++row) {
        const double utc_us = one->at(row, *utc);
        if (!(utc_us > kYear2001_us && utc_us < 9e15)) continue;
        const double offset_us = relative ? one->at(row, *relative) : 0.0;
        if (!(std::abs(offset_us) < 1e10)) continue;
        starts_us.push_back(utc_us - static_cast<double>(one->t_us[row]) - offset_us);
      }
    }
    if (!starts_us.empty()) break;
  }
  const double start_us = median(std::move(starts_us));
  if (!known(start_us)) return std::nullopt;
  return static_cast<TimeNs>(std::llround(start_us)) * 1000;
}

void px4_gps(const Log& log, const Clock& clock, const ConvertOptions& options, Vehicle& out) {
  std::vector<Candidate> ways;
  for (const char* topic : {"vehicle_gps_position", "sensor_gps"}) {
    for (const Series* one : log.of(topic)) {
      const Columns c(*one);
      if (!c.latitude || !c.longitude) continue;
      ways.push_back({one->label(), one, [=, &clock, &out] { convert(*one, clock, out); }});
    }
  }
  make_best("gps", ways, false, options, out);
}

}  // namespace fathom::logs

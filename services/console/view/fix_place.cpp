#include "console/view/fix_place.hpp"

#include <array>
#include <cmath>

#include "base/units.hpp"

namespace fathom::console {
namespace {

constexpr double kEarthM = 6371000.0;

/// Components along the frame of the fix; from range and direction where it has none.
std::optional<std::array<double, 3>> relative_of(const UsblSample& sample) {
  const auto& given = sample.relative_m;
  if (std::isfinite(given[0]) && std::isfinite(given[1])) return given;
  if (!std::isfinite(sample.range_m) || !std::isfinite(sample.bearing_rad)) return std::nullopt;
  const double depression = std::isfinite(sample.depression_rad) ? sample.depression_rad : 0.0;
  const double flat = sample.range_m * std::cos(depression);
  return std::array<double, 3>{flat * std::cos(sample.bearing_rad), flat * std::sin(sample.bearing_rad),
                               sample.range_m * std::sin(depression)};
}

/// Roll, pitch and yaw (ZYX) of the ship turn its forward-right-down into north and east.
std::array<double, 2> turned(const std::array<double, 3>& d, const std::array<double, 3>& rpy) {
  const double cr = std::cos(rpy[0]), sr = std::sin(rpy[0]);
  const double cp = std::cos(rpy[1]), sp = std::sin(rpy[1]);
  const double cy = std::cos(rpy[2]), sy = std::sin(rpy[2]);
  return {cy * cp * d[0] + (cy * sp * sr - sy * cr) * d[1] + (cy * sp * cr + sy * sr) * d[2],
          sy * cp * d[0] + (sy * sp * sr + cy * cr) * d[1] + (sy * sp * cr - cy * sr) * d[2]};
}

}  // namespace

std::optional<FixRow> place_of(const GpsSample& sample) {
  const bool measured = sample.fix >= GpsFix::fix_2d;
  if (!measured || !std::isfinite(sample.latitude_rad) || !std::isfinite(sample.longitude_rad))
    return std::nullopt;
  FixRow row;
  row.utc_ns = sample.header.stamp_ns;
  row.latitude_deg = sample.latitude_rad * kDegPerRad;
  row.longitude_deg = sample.longitude_rad * kDegPerRad;
  row.sigma_m = sample.position_sigma_N_m[0];
  row.source = SourceKind::gps;
  row.sensor = sample.header.sensor;
  return row;
}

std::optional<FixRow> place_of(const FixSample& sample) {
  if (!std::isfinite(sample.latitude_rad) || !std::isfinite(sample.longitude_rad)) return std::nullopt;
  FixRow row;
  row.utc_ns = sample.header.stamp_ns;
  row.latitude_deg = sample.latitude_rad * kDegPerRad;
  row.longitude_deg = sample.longitude_rad * kDegPerRad;
  row.sigma_m = sample.sigma_m;
  row.source = SourceKind::fix;
  row.sensor = sample.header.sensor;
  return row;
}

std::optional<FixRow> place_of(const UsblSample& sample) {
  FixRow row;
  row.utc_ns = sample.header.stamp_ns;
  row.sigma_m = sample.sigma_m;
  row.source = SourceKind::usbl;
  row.sensor = sample.header.sensor;
  double latitude = sample.latitude_rad;
  double longitude = sample.longitude_rad;
  if (sample.frame == UsblFrame::ned || sample.frame == UsblFrame::vessel_frd) {
    const auto relative = relative_of(sample);
    if (!relative) return std::nullopt;
    std::array<double, 2> north_east{(*relative)[0], (*relative)[1]};
    if (sample.frame == UsblFrame::vessel_frd) north_east = turned(*relative, sample.station_rpy_rad);
    latitude = sample.station_latitude_rad + north_east[0] / kEarthM;
    longitude =
        sample.station_longitude_rad + north_east[1] / (kEarthM * std::cos(sample.station_latitude_rad));
  } else if (sample.frame == UsblFrame::vehicle_frd) {
    return std::nullopt;
  }
  if (!std::isfinite(latitude) || !std::isfinite(longitude)) return std::nullopt;
  row.latitude_deg = latitude * kDegPerRad;
  row.longitude_deg = longitude * kDegPerRad;
  return row;
}

}  // namespace fathom::console

#include "sim/sensors/usbl.hpp"

#include <algorithm>
#include <cmath>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/encode/evologics.hpp"
#include "sim/encode/nmea.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double kSoundSpeed_m_s = 1500.0;

geo::Geodetic place_of(const TruthPoint& point) {
  return {point.latitude_rad, point.longitude_rad, point.altitude_m};
}

}  // namespace

UsblModel::UsblModel(const UsblConfig& config, const Scenario& scenario, std::uint64_t seed)
    : config_(config),
      random_(seed, "usbl"),
      start_(geo::moved_by({scenario.start.latitude_rad, scenario.start.longitude_rad,
                            scenario.environment.surface_altitude_m},
                           geo::vec(config.ship_N_m))),
      surface_altitude_m_(scenario.environment.surface_altitude_m) {
  Random mounting(seed, "usbl.mounting");
  const double roll = mounting.normal(config.misalignment_sigma_rad);
  const double pitch = mounting.normal(config.misalignment_sigma_rad);
  turn_ = q_of_rpy(roll, pitch, mounting.normal(config.misalignment_sigma_rad)).conjugate();
}

std::optional<UsblSample> UsblModel::sample(const TruthPoint& point) {
  const TruthPoint transponder = at_lever(point, geo::vec(config_.lever_B_m));
  const geo::Geodetic at = place_of(transponder);
  const geo::Geodetic ship = geo::moved_by(start_, point.t_s * geo::vec(config_.ship_velocity_N_m_s));
  const double range_m = geo::difference_N(ship, at).norm();
  const double sigma = std::hypot(config_.floor_m, config_.range_fraction * range_m);
  Vector3d error{random_.normal(sigma), random_.normal(sigma), random_.normal(sigma)};
  const double bearing = random_.uniform(0.0, 6.283185307179586);
  const bool polar =
      config_.output == UsblConfig::Output::range_bearing || config_.output == UsblConfig::Output::inverted;
  if (polar) error.setZero();  // theirs are errors of range and direction
  if (random_.chance(config_.outlier_probability)) {
    error += config_.outlier_m * Vector3d(std::cos(bearing), std::sin(bearing), 0.0);
  }
  if (transponder.depth_m < config_.minimum_depth_m) return std::nullopt;
  const geo::Geodetic heard = geo::moved_by(at, error);
  UsblSample out;
  out.transponder = std::string_view(config_.transponder);
  out.sigma_m = sigma;
  out.travel_time_s = range_m / kSoundSpeed_m_s;
  if (config_.output == UsblConfig::Output::geodetic) {
    out.frame = UsblFrame::geodetic;
    out.latitude_rad = heard.latitude_rad;
    out.longitude_rad = heard.longitude_rad;
    out.depth_m = surface_altitude_m_ - heard.altitude_m;
  } else {
    relative(out, transponder, ship, heard, sigma);
  }
  return out;
}

void UsblModel::relative(UsblSample& out, const TruthPoint& transponder, const geo::Geodetic& ship,
                         const geo::Geodetic& heard, double sigma_m) {
  using Output = UsblConfig::Output;
  const Output output = config_.output;
  const auto& rpy = config_.ship_rpy_rad;
  Vector3d path = geo::difference_N(ship, heard);
  if (output == Output::inverted) {
    out.frame = UsblFrame::vehicle_frd;
    path = transponder.q_NB.conjugate() * -path;
  } else if (output == Output::ned) {
    out.frame = UsblFrame::ned;
  } else {
    out.frame = UsblFrame::vessel_frd;
    out.station_rpy_rad = rpy;
    path = q_of_rpy(rpy[0], rpy[1], rpy[2]).conjugate() * path;
  }
  path = turn_ * path;
  if (output == Output::range_bearing || output == Output::inverted) {
    const double depression = std::atan2(path.z(), std::hypot(path.x(), path.y()));
    // Across the path: sideways it is a smaller circle the steeper the path.
    const double aside = random_.normal(config_.angle_sigma_rad) / std::max(std::cos(depression), 0.02);
    out.range_m = std::max(path.norm() + random_.normal(sigma_m), 0.01);
    out.bearing_rad = geo::wrap_two_pi(std::atan2(path.y(), path.x()) + aside);
    out.depression_rad = std::clamp(depression + random_.normal(config_.angle_sigma_rad), -1.5707963267948966,
                                    1.5707963267948966);
    out.sigma_rad = config_.angle_sigma_rad;
  } else {
    out.relative_m = geo::arr(path);
  }
  Vector3d astray;
  for (int i = 0; i < 3; ++i) astray(i) = random_.normal(config_.ship_sigma_m);
  const geo::Geodetic sent = geo::moved_by(ship, astray);
  out.station_latitude_rad = sent.latitude_rad;
  out.station_longitude_rad = sent.longitude_rad;
  out.station_depth_m = surface_altitude_m_ - sent.altitude_m;
}

double UsblModel::latency_s() {
  return random_.uniform(config_.latency_s, std::max(config_.latency_s, config_.maximum_latency_s));
}

Bytes SimulatedDevice<UsblSample>::encode(const UsblSample& usbl, const DeviceCall& device) {
  if (device.protocol == "psonlld") return bytes_of(encode::psonlld(usbl, usbl.header.stamp_ns));
  if (device.protocol == "evologics")
    return bytes_of(encode::evologics(usbl, usbl.header.stamp_ns - device.power_on_ns,
                                      usbl.header.received_ns - device.power_on_ns));
  return bytes_of(encode::psimssb(usbl, usbl.header.stamp_ns));
}

}  // namespace fathom::sim

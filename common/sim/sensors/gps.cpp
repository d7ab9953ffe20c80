#include "sim/sensors/gps.hpp"

#include <cmath>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/encode/imu/microstrain.hpp"
#include "sim/encode/imu/sbg.hpp"
#include "sim/encode/imu/vectornav.hpp"
#include "sim/encode/imu/xsens.hpp"
#include "sim/encode/nmea.hpp"
#include "sim/encode/novatel.hpp"
#include "sim/encode/sbf.hpp"
#include "sim/encode/ubx.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

using Eigen::Vector3d;

GpsModel::GpsModel(const GpsConfig& config, const EnvironmentConfig& environment, std::uint64_t seed)
    : config_(config),
      environment_(environment),
      random_(seed, "gps"),
      drift_{GaussMarkov(config.correlated_sigma_m, config.correlated_tau_s, random_),
             GaussMarkov(config.correlated_sigma_m, config.correlated_tau_s, random_),
             GaussMarkov(config.correlated_altitude_sigma_m, config.correlated_tau_s, random_)},
      clear_since_s_(-config.reacquire_s) {}

void GpsModel::observe(const TruthPoint& point) {
  const double antenna_depth_m = point.depth_m + (point.q_NB * geo::vec(config_.lever_B_m)).z();
  const bool clear = antenna_depth_m < -config_.antenna_clearance_m && !inside(config_.dropouts, point.t_s);
  if (!clear) clear_since_s_ = point.t_s;
  available_ = clear && point.t_s >= clear_since_s_ + config_.reacquire_s - 1e-9;
}

GpsSample GpsModel::sample(const TruthPoint& point) {
  const double dt = point.t_s - last_sample_s_;
  last_sample_s_ = point.t_s;
  // Drawn whether or not there is a fix, so that an outage leaves the later noise as it was.
  Vector3d error{drift_[0].advance(dt, random_) + random_.normal(config_.position_sigma_m),
                 drift_[1].advance(dt, random_) + random_.normal(config_.position_sigma_m),
                 drift_[2].advance(dt, random_) + random_.normal(config_.altitude_sigma_m)};
  const Vector3d velocity_error{random_.normal(config_.velocity_sigma_m_s),
                                random_.normal(config_.velocity_sigma_m_s),
                                random_.normal(config_.velocity_down_sigma_m_s)};
  const bool outlier = random_.chance(config_.outlier_probability);
  const double bearing = random_.uniform(0.0, 6.283185307179586);
  if (outlier) error += config_.outlier_m * Vector3d(std::cos(bearing), std::sin(bearing), 0.0);

  GpsSample out;
  if (!available_) {
    out.fix = GpsFix::none;
    out.satellites = 0;
    return out;
  }
  const TruthPoint antenna = at_lever(point, geo::vec(config_.lever_B_m));
  const geo::Geodetic fix =
      geo::moved_by({antenna.latitude_rad, antenna.longitude_rad, antenna.altitude_m}, error);
  out.fix = GpsFix::fix_3d;
  out.satellites = 11;
  out.latitude_rad = fix.latitude_rad;
  out.longitude_rad = fix.longitude_rad;
  out.altitude_m = fix.altitude_m;
  out.altitude_msl_m = fix.altitude_m - environment_.geoid_separation_m;
  const double horizontal = std::hypot(config_.position_sigma_m, config_.correlated_sigma_m);
  const double vertical = std::hypot(config_.altitude_sigma_m, config_.correlated_altitude_sigma_m);
  out.position_sigma_N_m = {horizontal, horizontal, vertical};
  const Vector3d v_N = antenna.v_N_m_s + velocity_error;
  out.velocity_N_m_s = geo::arr(v_N);
  out.velocity_sigma_N_m_s = {config_.velocity_sigma_m_s, config_.velocity_sigma_m_s,
                              config_.velocity_down_sigma_m_s};
  out.hdop = 0.9;
  if (std::hypot(v_N.x(), v_N.y()) > 0.2) out.course_rad = geo::wrap_two_pi(std::atan2(v_N.y(), v_N.x()));
  return out;
}

Bytes SimulatedDevice<GpsSample>::encode(const GpsSample& gps, const DeviceCall& device) {
  if (device.protocol == "microstrain") return encode::microstrain_gnss(gps, gps.header.stamp_ns);
  if (device.protocol == "novatel") return encode::novatel_epoch(gps, gps.header.stamp_ns);
  if (device.protocol == "sbg") {
    const DurationNs since_power_on_ns = gps.header.stamp_ns - device.power_on_ns;
    return encode::sbg_epoch(gps, gps.header.stamp_ns, since_power_on_ns);
  }
  if (device.protocol == "sbf") return encode::sbf_epoch(gps, gps.header.stamp_ns);
  if (device.protocol == "ubx") return encode::ubx_nav_pvt(gps, gps.header.stamp_ns);
  if (device.protocol == "vectornav") return encode::vectornav_fix({gps, gps.header.stamp_ns});
  if (device.protocol == "xsens") return encode::xsens_fix(gps, gps.header.stamp_ns);
  return bytes_of(encode::nmea_gps(gps, gps.header.stamp_ns));
}

}  // namespace fathom::sim

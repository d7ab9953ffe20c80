#include "sim/sensors/heading.hpp"

#include <cmath>

#include "geo/so3.hpp"
#include "sim/encode/imu/sbg.hpp"
#include "sim/encode/nmea.hpp"
#include "sim/encode/novatel.hpp"
#include "sim/encode/sbf.hpp"
#include "sim/encode/ubx.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {

HeadingModel::HeadingModel(const HeadingConfig& config, const EnvironmentConfig& environment,
                           std::uint64_t seed)
    : config_(config),
      variation_rad_(environment.magnetic_variation_rad),
      random_(seed, "heading"),
      bias_rad_(random_.normal(config.bias_sigma_rad)) {}

HeadingSample HeadingModel::sample(const TruthPoint& point) {
  const double noise = random_.normal(config_.sigma_rad);
  const bool outlier = random_.chance(config_.outlier_probability);
  const double yaw = rpy_of(point.q_NB).z();
  const auto& d = config_.deviation_rad;
  double heading = yaw + bias_rad_ + noise + d[0] + d[1] * std::sin(yaw) + d[2] * std::cos(yaw) +
                   d[3] * std::sin(2.0 * yaw) + d[4] * std::cos(2.0 * yaw);
  if (outlier) heading += config_.outlier_rad;
  HeadingSample out;
  if (config_.magnetic) {
    out.north = North::magnetic;
    out.variation_rad = variation_rad_;
    heading -= variation_rad_;
  }
  out.heading_rad = geo::wrap_two_pi(heading);
  return out;
}

Bytes SimulatedDevice<HeadingSample>::encode(const HeadingSample& heading, const DeviceCall& device) {
  if (device.protocol == "sbf") return encode::sbf_attitude_epoch(heading, heading.header.stamp_ns);
  if (device.protocol == "ubx") return encode::ubx_nav_relposned(heading, heading.header.stamp_ns);
  if (device.protocol == "novatel") return encode::novatel_heading(heading, heading.header.stamp_ns);
  if (device.protocol == "sbg") {
    const TimeNs stamp_ns = heading.header.stamp_ns;
    return encode::sbg_gps_heading(heading, stamp_ns, stamp_ns - device.power_on_ns);
  }
  if (device.protocol == "nmea_attitude")
    return bytes_of(encode::nmea_attitude(heading, heading.header.stamp_ns));
  return bytes_of(encode::nmea_heading(heading));
}

}  // namespace fathom::sim

// What is considered of the errors of the instruments that a configuration carries (KF-6).
#include <algorithm>

#include "estimation/engine_config.hpp"

namespace fathom::estimation {

StateGroups EngineConfig::considered() const {
  StateGroups out;
  if (left_out == LeftOut::noise) return out;
  const auto carries = [&](SourceKind kind) {
    return std::any_of(sensors.begin(), sensors.end(),
                       [&](const SensorConfig& one) { return one.kind == kind; });
  };
  out.accel_scale = !groups.accel_scale && imu.accel_scale_sigma > 0.0;
  out.gyro_scale = !groups.gyro_scale && imu.gyro_scale_sigma > 0.0;
  out.accel_misalignment = !groups.accel_misalignment && imu.accel_misalignment_sigma_rad > 0.0;
  out.gyro_misalignment = !groups.gyro_misalignment && imu.gyro_misalignment_sigma_rad > 0.0;
  out.dvl_scale = carries(SourceKind::dvl) && !groups.dvl_scale && !groups.dvl_scale_xyz;
  out.dvl_misalignment = carries(SourceKind::dvl) && !groups.dvl_misalignment;
  out.heading_bias = !groups.heading_bias && std::any_of(sensors.begin(), sensors.end(), [](const auto& one) {
    return one.kind == SourceKind::heading && !one.two_antenna;
  });
  out.gps_position_bias = carries(SourceKind::gps) && !groups.gps_position_bias;
  out.usbl_bias = carries(SourceKind::usbl) && !groups.usbl_bias;
  out.antenna_bias = !groups.antenna_bias && std::any_of(sensors.begin(), sensors.end(), [](const auto& one) {
    return one.kind == SourceKind::heading && one.two_antenna;
  });
  out.dvl_bias = carries(SourceKind::dvl) && !groups.dvl_bias && states.dvl_bias_sigma_m_s > 0.0;
  out.beacon_place = carries(SourceKind::range) && !groups.beacon_place;
  return out;
}

}  // namespace fathom::estimation

#include <algorithm>
#include <cmath>

#include "config/bridge/bridge_schema.hpp"

namespace fathom::config {
namespace {

using Matrix = std::array<double, 9>;

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix out{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      for (std::size_t k = 0; k < 3; ++k) out[3 * row + column] += a[3 * row + k] * b[3 * k + column];
    }
  }
  return out;
}

double pascal(DepthUnit unit) {
  switch (unit) {
    case DepthUnit::psi:
      return 6'894.757293168;
    case DepthUnit::dbar:
      return 1e4;
    case DepthUnit::bar:
      return 1e5;
    case DepthUnit::mbar:
      return 100.0;
    case DepthUnit::kPa:
      return 1e3;
    case DepthUnit::m:
    case DepthUnit::Pa:
      break;
  }
  return 1.0;
}

/// The message rate of a KVH unit. A rate that was measured stands for the one of the unit's own (=DR) that
/// is within 1 % of it. Where none is, the rate counts as it is: such a unit is triggered (=MSYNC,EXT).
double kvh_rate_hz(double rate_hz) {
  constexpr double kFar = 0.01;
  for (const double own :
       {1.0, 5.0, 10.0, 25.0, 50.0, 100.0, 250.0, 500.0, 750.0, 1'000.0, 3'600.0, 5'000.0}) {
    if (std::abs(rate_hz - own) < kFar * own) return own;
  }
  return rate_hz;
}

}  // namespace

SensorPlan plan_of(const SensorConfig& sensor) {
  SensorPlan out;
  out.sensor = sensor;
  out.options.mavlink_system = sensor.mavlink_system;
  if (out.sensor.source.silence_s <= 0.0) out.sensor.source.silence_s = stale_after_s(sensor);
  return out;
}

std::array<double, 9> MountingConfig::rotation() const {
  if (frame == MountingFrame::matrix && R_BS) return *R_BS;
  const double cr = std::cos(rpy_rad[0]), sr = std::sin(rpy_rad[0]);
  const double cp = std::cos(rpy_rad[1]), sp = std::sin(rpy_rad[1]);
  const double cy = std::cos(rpy_rad[2]), sy = std::sin(rpy_rad[2]);
  const Matrix turn{cy * cp,
                    cy * sp * sr - sy * cr,
                    cy * sp * cr + sy * sr,
                    sy * cp,
                    sy * sp * sr + cy * cr,
                    sy * sp * cr - cy * sr,
                    -sp,
                    cp * sr,
                    cp * cr};
  if (frame == MountingFrame::flu) return product(turn, Matrix{1, 0, 0, 0, -1, 0, 0, 0, -1});
  return turn;
}

double stale_after_s(const SensorConfig& config) {
  if (config.stale_after_s > 0.0) return config.stale_after_s;
  return std::max(2.0, 5.0 / config.rate_hz);
}

SensorPlan sensor_plan(const ImuSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.R_BS = config.mounting.rotation();
  out.options.stim300 = config.stim300;
  out.options.kvh.increments_hz =
      config.kvh.rotation == KvhRotation::delta ? kvh_rate_hz(config.sensor.rate_hz) : 0.0;
  out.options.kvh.degrees = config.kvh.angle == KvhAngle::degree;
  out.options.kvh.temperature = config.kvh.temperature;
  out.limits.angular_rate_rad_s = config.max_angular_rate_rad_s;
  out.limits.specific_force_m_s2 = config.max_specific_force_m_s2;
  return out;
}

SensorPlan sensor_plan(const DvlSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.dvl_heading_alignment_rad = config.heading_alignment_rad;
  out.limits.dvl_speed_m_s = config.max_speed_m_s;
  return out;
}

SensorPlan sensor_plan(const GpsSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  out.limits.gps_speed_m_s = config.max_speed_m_s;
  return out;
}

SensorPlan sensor_plan(const DepthSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  const double unit = pascal(config.unit);
  out.options.value_is_depth = config.unit == DepthUnit::m;
  out.options.pressure_unit_Pa = unit;
  out.options.latitude_rad = config.latitude_rad;
  out.options.atmosphere_Pa = config.atmosphere_Pa;
  out.options.ascii_scale = config.ascii.scale * unit;
  out.options.ascii_offset = config.ascii.offset * unit;
  out.ascii_prefix = config.ascii.prefix;
  out.limits.depth_m = config.max_depth_m;
  return out;
}

SensorPlan sensor_plan(const HeadingSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  out.options.untold_north = config.north;
  return out;
}

SensorPlan sensor_plan(const UsblSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  out.options.usbl = {config.carried_by, config.sigma_floor_m};
  out.options.beacons = beacon_options(config.beacons);
  out.transponder = config.transponder;
  out.intermittent = true;  // out of earshot is no fault
  out.limits.acoustic_range_m = config.max_range_m;
  return out;
}

SensorPlan sensor_plan(const ActuatorSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  out.limits.rpm = config.max_rpm;
  out.limits.fin_rad = config.max_fin_rad;
  return out;
}

SensorPlan sensor_plan(const AirDataSensorConfig& config) {
  SensorPlan out = plan_of(config.sensor);
  out.options.require_checksum = config.require_checksum;
  codec::AirDataOptions& air = out.options.air_data;
  air.wanted = config.wanted;
  air.prefix = std::string_view(config.line.prefix);
  air.separator = config.line.separator.front();
  air.count = config.line.columns.size();
  for (std::size_t i = 0; i < air.count; ++i)
    air.columns[i] = {config.line.columns[i].quantity, config.line.columns[i].unit};
  const auto names = config.transducers.list();
  for (std::size_t i = 0; i < names.size(); ++i) air.transducer[i] = std::string_view(names[i]);
  out.limits.airspeed_m_s = config.max_airspeed_m_s;
  return out;
}

}  // namespace fathom::config

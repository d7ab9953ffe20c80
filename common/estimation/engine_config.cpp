#include "estimation/engine_config.hpp"

#include <cmath>
#include <set>
#include <sstream>

#include "estimation/filter/state_index.hpp"

namespace fathom::estimation {
namespace {

/// Collects the first complaint.
class Check {
 public:
  void in(const std::string& key, double value, double low, double high) {
    if (!text_.empty() || (std::isfinite(value) && value >= low && value <= high)) return;
    std::ostringstream out;
    out << key << ": " << value << ": expected a number from " << low << " to " << high;
    text_ = out.str();
  }
  template <std::size_t N>
  void in(const std::string& key, const std::array<double, N>& values, double low, double high) {
    for (std::size_t i = 0; i < values.size(); ++i)
      in(key + "[" + std::to_string(i) + "]", values[i], low, high);
  }
  void that(bool good, const std::string& complaint) {
    if (text_.empty() && !good) text_ = complaint;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

constexpr double kAngle = 6.2831853071795865;

void check_imu(const ImuConfig& imu, Check& check) {
  check.in("imu.mounting_rpy_rad", imu.mounting_rpy_rad, -kAngle, kAngle);
  check.in("imu.nominal_rate_hz", imu.nominal_rate_hz, 1, 2000);
  check.in("imu.angle_random_walk_rad_sqrt_s", imu.angle_random_walk_rad_sqrt_s, 1e-9, 1);
  check.in("imu.velocity_random_walk_m_s_sqrt_s", imu.velocity_random_walk_m_s_sqrt_s, 1e-9, 10);
  check.in("imu.gyro_bias_sigma_rad_s", imu.gyro_bias_sigma_rad_s, 1e-12, 1);
  check.in("imu.gyro_bias_instability_rad_s", imu.gyro_bias_instability_rad_s, 0, 1);
  check.in("imu.gyro_bias_time_constant_s", imu.gyro_bias_time_constant_s, 1, 1e9);
  check.in("imu.accel_bias_sigma_m_s2", imu.accel_bias_sigma_m_s2, 1e-9, 10);
  check.in("imu.accel_bias_instability_m_s2", imu.accel_bias_instability_m_s2, 0, 10);
  check.in("imu.accel_bias_time_constant_s", imu.accel_bias_time_constant_s, 1, 1e9);
  check.in("imu.gyro_bias_settling_rad_s", imu.gyro_bias_settling_rad_s, 0, 1);
  check.in("imu.accel_bias_settling_m_s2", imu.accel_bias_settling_m_s2, 0, 10);
  check.in("imu.bias_settling_time_s", imu.bias_settling_time_s, 0.1, 1e6);
  check.in("imu.gyro_scale_sigma", imu.gyro_scale_sigma, 0, 0.1);
  check.in("imu.accel_scale_sigma", imu.accel_scale_sigma, 0, 0.1);
  check.in("imu.gyro_misalignment_sigma_rad", imu.gyro_misalignment_sigma_rad, 0, 0.1);
  check.in("imu.accel_misalignment_sigma_rad", imu.accel_misalignment_sigma_rad, 0, 0.1);
  check.in("imu.equivalent_noise_time_s", imu.equivalent_noise_time_s, 0, 100);
  check.in("imu.max_rate_rad_s", imu.max_rate_rad_s, 0.1, 1000);
  check.in("imu.max_specific_force_m_s2", imu.max_specific_force_m_s2, 15, 1e5);
  check.in("imu.max_gap_s", imu.max_gap_s, 1e-3, 10);
  check.in("imu.lost_gap_s", imu.lost_gap_s, imu.max_gap_s, 3600);
  check.in("imu.gap_rate_sigma_rad_s", imu.gap_rate_sigma_rad_s, 0, 10);
  check.in("imu.gap_acceleration_sigma_m_s2", imu.gap_acceleration_sigma_m_s2, 0, 100);
}

void check_states(const StateModelConfig& states, Check& check) {
  check.in("states.dvl_scale_sigma", states.dvl_scale_sigma, 1e-6, 1);
  check.in("states.dvl_misalignment_sigma_rad", states.dvl_misalignment_sigma_rad, 1e-6, 1);
  check.in("states.dvl_bias_sigma_m_s", states.dvl_bias_sigma_m_s, 1e-6, 10);
  check.in("states.current_sigma_m_s", states.current_sigma_m_s, 1e-6, 100);
  check.in("states.current_time_constant_s", states.current_time_constant_s, 0, 1e9);
  check.in("states.depth_bias_sigma_m", states.depth_bias_sigma_m, 1e-6, 100);
  check.in("states.surface_altitude_m", states.surface_altitude_m, -500, 9000);
  check.in("states.surface_altitude_sigma_m", states.surface_altitude_sigma_m, 1e-6, 1e4);
  check.in("states.surface_altitude_walk_m_sqrt_s", states.surface_altitude_walk_m_sqrt_s, 0, 1);
  check.in("states.heading_bias_sigma_rad", states.heading_bias_sigma_rad, 1e-6, 3);
  check.in("states.heading_bias_time_constant_s", states.heading_bias_time_constant_s, 0, 1e9);
  check.in("states.heading_deviation_sigma_rad", states.heading_deviation_sigma_rad, 1e-6, 3);
  check.in("states.usbl_bias_sigma_m", states.usbl_bias_sigma_m, 1e-6, 1e4);
  check.in("states.gps_bias_sigma_m", states.gps_bias_sigma_m, 1e-6, 100);
  check.in("states.gps_bias_time_constant_s", states.gps_bias_time_constant_s, 1, 1e9);
  check.in("states.usbl_misalignment_sigma_rad", states.usbl_misalignment_sigma_rad, 1e-6, 1);
  check.in("states.gps_latency_sigma_s", states.gps_latency_sigma_s, 1e-6, 10);
  check.in("states.gps_lever_sigma_m", states.gps_lever_sigma_m, 1e-6, 100);
  check.in("states.log_scale_sigma", states.log_scale_sigma, 1e-6, 1);
  check.in("states.airspeed_bias_sigma_m_s", states.airspeed_bias_sigma_m_s, 1e-6, 100);
  check.in("states.airspeed_scale_sigma", states.airspeed_scale_sigma, 1e-6, 1);
  check.in("states.flow_angle_sigma_rad", states.flow_angle_sigma_rad, 1e-6, 1);
  check.in("states.flow_angle_time_constant_s", states.flow_angle_time_constant_s, 1e-2, 1e9);
  check.in("states.baro_bias_sigma_m", states.baro_bias_sigma_m, 1e-6, 1e4);
  check.in("states.baro_bias_walk_m_sqrt_s", states.baro_bias_walk_m_sqrt_s, 0, 100);
  check.in("states.mount_angle_sigma_rad", states.mount_angle_sigma_rad, 1e-6, 1);
  check.in("states.mount_lever_sigma_m", states.mount_lever_sigma_m, 1e-6, 100);
  check.in("states.model_scale_sigma", states.model_scale_sigma, 1e-6, 1);
  check.in("states.model_bias_sigma_m_s", states.model_bias_sigma_m_s, 1e-6, 10);
  check.in("states.model_bias_time_constant_s", states.model_bias_time_constant_s, 1, 1e9);
}

void check_sensor(const SensorConfig& sensor, Check& check) {
  const std::string at = "sensors." + sensor.sensor + ".";
  check.in(at + "lever_B_m", sensor.lever_B_m, -1000, 1000);
  check.in(at + "mounting_rpy_rad", sensor.mounting_rpy_rad, -kAngle, kAngle);
  check.in(at + "latency_s", sensor.latency_s, -10, 60);
  check.in(at + "sigma", sensor.sigma, 1e-6, 1e6);
  check.in(at + "velocity_sigma_m_s", sensor.velocity_sigma_m_s, 1e-6, 1e3);
  check.in(at + "proportional_sigma", sensor.proportional_sigma, 0, 10);
  check.in(at + "min_fix", sensor.min_fix, 0, 7);
  check.in(at + "gate_probability", sensor.gate_probability, 0.5, 1.0);
  check.in(at + "robust_parameter", sensor.robust_parameter, 0.1, 1e3);
  check.in(at + "robust_reject_ratio", sensor.robust_reject_ratio, 1, 1e12);
  check.in(at + "reacquire_s", sensor.reacquire_s, 0, 1e6);
  check.in(at + "reacquire_step_m", sensor.reacquire_step_m, 0.1, 1e6);
  check.in(at + "frozen_change", sensor.frozen_change, 0, 1e6);
  check.in(at + "angle_sigma_rad", sensor.angle_sigma_rad, 1e-6, 4);
  check.in(at + "transceiver_latitude_rad", sensor.transceiver_latitude_rad, -kAngle / 4, kAngle / 4);
  check.in(at + "transceiver_longitude_rad", sensor.transceiver_longitude_rad, -kAngle, kAngle);
  check.in(at + "transceiver_depth_m", sensor.transceiver_depth_m, -1000, 12000);
  check.in(at + "sideslip_sigma_rad", sensor.sideslip_sigma_rad, 0, 1);
  check.in(at + "attack_sigma_rad", sensor.attack_sigma_rad, 0, 1);
  check.in(at + "gust_time_s", sensor.gust_time_s, 0, 1000);
  check.in(at + "baro_sigma_m", sensor.baro_sigma_m, 0, 1e4);
  check.in(at + "beam_angle_rad", sensor.beam_angle_rad, 0.05, 1.4);
  check.in(at + "beam_azimuth_rad", sensor.beam_azimuth_rad, -kAngle, kAngle);
  check.in(at + "scale_m_s_per_rpm", sensor.scale_m_s_per_rpm, -10, 10);
  check.in(at + "min_depth_m", sensor.min_depth_m, -1000, 12000);
  check.in(at + "slip_time_s", sensor.slip_time_s, 0, 1000);
  check.that(sensor.kind != SourceKind::imu, at + "kind: imu: expected an aiding sensor");
}

void check_alignment(const AlignmentConfig& alignment, Check& check) {
  check.in("alignment.given_heading_rad", alignment.given_heading_rad, -kAngle, kAngle);
  check.in("alignment.given_heading_sigma_rad", alignment.given_heading_sigma_rad, 1e-5, 4);
  check.in("alignment.given_latitude_rad", alignment.given_latitude_rad, -kAngle / 4, kAngle / 4);
  check.in("alignment.given_longitude_rad", alignment.given_longitude_rad, -kAngle, kAngle);
  check.in("alignment.given_altitude_m", alignment.given_altitude_m, -12000, 50000);
  check.in("alignment.averaging_s", alignment.averaging_s, 0.5, 3600);
  check.in("alignment.rate_spread_rad_s", alignment.rate_spread_rad_s, 1e-6, 10);
  check.in("alignment.force_spread_m_s2", alignment.force_spread_m_s2, 1e-5, 100);
  check.in("alignment.max_speed_m_s", alignment.max_speed_m_s, 1e-3, 100);
  check.in("alignment.rest_velocity_sigma_m_s", alignment.rest_velocity_sigma_m_s, 1e-4, 10);
  check.in("alignment.tilt_sigma_floor_rad", alignment.tilt_sigma_floor_rad, 1e-6, 1);
  check.in("alignment.compass_sigma_rad", alignment.compass_sigma_rad, 1e-5, 4);
  check.in("alignment.gyrocompass_limit_rad", alignment.gyrocompass_limit_rad, 1e-5, 4);
  check.in("alignment.in_motion_speed_m_s", alignment.in_motion_speed_m_s, 0.1, 1000);
  check.in("alignment.in_motion_heading_sigma_rad", alignment.in_motion_heading_sigma_rad, 1e-4, 4);
  check.in("alignment.in_motion_tilt_sigma_rad", alignment.in_motion_tilt_sigma_rad, 1e-4, 1);
  check.in("alignment.in_motion_averaging_s", alignment.in_motion_averaging_s, 0.1, 600);
  check.in("alignment.aligned_tilt_sigma_rad", alignment.aligned_tilt_sigma_rad, 1e-6, 1);
  check.in("alignment.aligned_heading_sigma_rad", alignment.aligned_heading_sigma_rad, 1e-6, 4);
  check.in("alignment.aligned_hold_s", alignment.aligned_hold_s, 0, 600);
  check.in("alignment.timeout_s", alignment.timeout_s, 1, 1e6);
  check.in("alignment.position_sigma_m", alignment.position_sigma_m, 1e-3, 1e4);
}

void check_constraints(const ConstraintsConfig& constraints, Check& check) {
  const NonHolonomicConfig& wheels = constraints.non_holonomic;
  check.in("constraints.non_holonomic.rate_hz", wheels.rate_hz, 0.01, 1000);
  check.in("constraints.non_holonomic.lever_B_m", wheels.lever_B_m, -1000, 1000);
  check.in("constraints.non_holonomic.mounting_rpy_rad", wheels.mounting_rpy_rad, -kAngle, kAngle);
  check.in("constraints.non_holonomic.lateral_sigma_m_s", wheels.lateral_sigma_m_s, 1e-5, 1e3);
  check.in("constraints.non_holonomic.vertical_sigma_m_s", wheels.vertical_sigma_m_s, 1e-5, 1e3);
  check.in("constraints.non_holonomic.slip_time_s", wheels.slip_time_s, 0, 1000);
  check.in("constraints.constant_depth.rate_hz", constraints.constant_depth.rate_hz, 0.01, 1000);
  check.in("constraints.constant_depth.sigma_m_s", constraints.constant_depth.sigma_m_s, 1e-5, 1e3);
}

void check_vehicle_model(const VehicleModelConfig& model, const StateGroups& groups, Check& check) {
  check.in("vehicle_model.origin_B_m", model.origin_B_m, -1000, 1000);
  for (const double sigma : model.sigma_m_s) check.in("vehicle_model.sigma_m_s", sigma, 1e-4, 10);
  check.in("vehicle_model.correlation_time_s", model.correlation_time_s, 0.01, 1000);
  check.in("vehicle_model.fins_timeout_s", model.fins_timeout_s, 0.05, 1e6);
  check.in("vehicle_model.min_depth_m", model.min_depth_m, -1000, 12000);
  check.in("vehicle_model.settle_s", model.settle_s, 0, 1e6);
  check.in("vehicle_model.memory_s", model.memory_s, 1, 1e6);
  check.in("vehicle_model.trial_s", model.trial_s, 0, 1e6);
  check.in("vehicle_model.doubt_limit", model.doubt_limit, 1, 100);
  if (!model.enabled) return;
  const std::string complaint = model.coefficients.validate();
  check.that(complaint.empty(), "vehicle_model.coefficients." + complaint);
  check.that(groups.current, "groups.current: false: expected true where vehicle_model is enabled");
  check.that(groups.model_bias, "groups.model_bias: false: expected true where vehicle_model is enabled");
}

void check_air_drop(const DropConfig& drop, Check& check) {
  const auto own = [&](const char* key, double value, double low, double high) {
    if (known(value)) {
      check.in(std::string("air_drop.") + key, value, low, high);
    } else {
      check.that(false, std::string("air_drop.") + key +
                            ": missing: expected the vehicle's own value where the start is an air drop");
    }
  };
  own("slip_per_turn_m", drop.slip_per_turn_m, 0, 100);
  own("trim_m2_s2", drop.trim_m2_s2, -1000, 1000);
  own("flow_lag_m", drop.flow_lag_m, 0.01, 1000);
  own("surge_tau_s", drop.surge_tau_s, 0.05, 600);
  own("speed_lag_s", drop.speed_lag_s, 0, 10);
}

}  // namespace

bool named_state_groups(const std::string& name, StateGroups& groups) {
  StateGroups wanted;
  if (name == "gps_ins15") {
    groups = wanted;
    return true;
  }
  if (name == "gps_ins24" || name == "gps_ins36") {
    wanted.accel_scale = wanted.gyro_scale = wanted.gps_position_bias = true;
    wanted.accel_misalignment = wanted.gyro_misalignment = name == "gps_ins36";
    groups = wanted;
    return true;
  }
  if (name == "standard") {
    wanted.dvl_scale = wanted.dvl_misalignment = true;
    wanted.current = wanted.surface_altitude = wanted.heading_bias = wanted.gps_position_bias = true;
    groups = wanted;
    return true;
  }
  if (name == "hybrid25") {
    wanted.usbl_bias = wanted.depth_bias = wanted.dvl_scale_xyz = wanted.heading_bias = true;
    wanted.usbl_misalignment = true;
    groups = wanted;
    return true;
  }
  if (name == "full") {
    wanted.accel_scale = wanted.gyro_scale = wanted.accel_misalignment = wanted.gyro_misalignment = true;
    wanted.dvl_scale = wanted.dvl_misalignment = wanted.current = wanted.surface_altitude = true;
    wanted.heading_bias = wanted.heading_deviation = wanted.gps_position_bias = true;
    wanted.usbl_bias = wanted.usbl_misalignment = true;
    groups = wanted;
    return true;
  }
  return false;
}

SensorConfig default_sensor(SourceKind kind, const std::string& name) {
  SensorConfig sensor;
  sensor.sensor = name;
  sensor.kind = kind;
  switch (kind) {
    case SourceKind::gps:
      sensor.sigma = {1.5, 1.5, 3.0};
      sensor.reacquire_s = 21.0;
      sensor.frozen_change = 2.0;
      break;
    case SourceKind::dvl:
      sensor.sigma = {0.01, 0.01, 0.01};
      sensor.proportional_sigma = 0.002;
      sensor.robust = RobustKind::student_t;
      sensor.reacquire_s = 5.0;
      sensor.frozen_change = 0.1;
      break;
    case SourceKind::depth:
      sensor.sigma = {0.05, 0.05, 0.05};
      sensor.reacquire_s = 5.0;
      sensor.frozen_change = 1.0;
      break;
    case SourceKind::heading:
      sensor.sigma = {0.0087, 0.0087, 0.0087};
      sensor.robust = RobustKind::student_t;
      sensor.reacquire_s = 30.0;
      sensor.frozen_change = 0.1;
      break;
    case SourceKind::usbl:
      sensor.sigma = {2.0, 2.0, 2.0};
      sensor.robust = RobustKind::student_t;
      sensor.reacquire_s = 60.0;
      break;
    case SourceKind::airspeed:
      sensor.sigma = {1.0, 1.0, 1.0};
      sensor.robust = RobustKind::student_t;
      break;
    case SourceKind::propulsion:
      sensor.sigma = {0.15, 0.1, 0.1};
      sensor.proportional_sigma = 0.01;
      sensor.robust = RobustKind::student_t;
      break;
    default:
      break;
  }
  return sensor;
}

EngineConfig::EngineConfig() {
  (void)named_state_groups(configuration, groups);
  forecast_limits = {{"horizontal_10m", 10.0}, {"horizontal_100m", 100.0}, {"heading_3deg", 0.0524}};
}

std::string EngineConfig::validate() const {
  Check check;
  check.that(!vehicle.empty() && vehicle.size() <= 31,
             "vehicle: " + vehicle + ": expected 1 to 31 characters");
  check.that(!sensor.empty() && sensor.size() <= 31, "sensor: " + sensor + ": expected 1 to 31 characters");
  check.that(!(groups.dvl_scale && groups.dvl_scale_xyz),
             "groups.dvl_scale_xyz: true: expected false where dvl_scale is true");
  check.that(state_count(groups) <= kMaxStates, "groups: " + std::to_string(state_count(groups)) +
                                                    " states: expected at most " +
                                                    std::to_string(kMaxStates) + " together");
  check_imu(imu, check);
  check_states(states, check);
  check_alignment(alignment, check);
  check_constraints(constraints, check);
  check_vehicle_model(vehicle_model, groups, check);
  if (alignment.mode == StartMode::air_drop) check_air_drop(air_drop, check);
  std::set<std::pair<std::string, bool>> names;
  check.that(sensors.size() <= 24, "sensors: " + std::to_string(sensors.size()) + ": expected at most 24");
  for (const SensorConfig& one : sensors) {
    check.that(!one.sensor.empty() && one.sensor.size() <= 31,
               "sensors.sensor: " + one.sensor + ": expected 1 to 31 characters");
    // One controller may tell shaft speed and fins under one name.
    check.that(names.emplace(one.sensor, one.kind == SourceKind::fins).second,
               "sensors.sensor: " + one.sensor + ": expected each name once, but that fins may share one");
    check_sensor(one, check);
  }
  check.in("horizon_s", horizon_s, 0.1, 60);
  check.in("snapshot_interval_s", snapshot_interval_s, 0.01, horizon_s);
  check.in("future_tolerance_s", future_tolerance_s, 0, 60);
  check.in("replay_steps_per_sample", replay_steps_per_sample, 2, 1e6);
  check.in("measurement_capacity", measurement_capacity, 64, 65535);
  check.in("magnetic_variation_rad", magnetic_variation_rad, -kAngle, kAngle);
  check.in("gps_timeout_s", gps_timeout_s, 0.1, 1e5);
  check.in("usbl_timeout_s", usbl_timeout_s, 0.1, 1e5);
  check.in("velocity_timeout_s", velocity_timeout_s, 0.1, 1e5);
  check.in("zero_velocity_sigma_m_s", zero_velocity_sigma_m_s, 1e-5, 10);
  check.in("output_lever_B_m", output_lever_B_m, -1000, 1000);
  check.in("forecast_span_s", forecast_span_s, 1, 7200);
  check.that(forecast_limits.size() <= 8,
             "forecast_limits: " + std::to_string(forecast_limits.size()) + ": expected at most 8");
  for (const ForecastLimitConfig& limit : forecast_limits) {
    check.that(!limit.name.empty() && limit.name.size() <= 31,
               "forecast_limits.name: " + limit.name + ": expected 1 to 31 characters");
    check.in("forecast_limits." + limit.name, limit.limit, 1e-6, 1e7);
  }
  return check.text();
}

}  // namespace fathom::estimation

#include <numbers>
#include <string>

#include "config/fusion/engine_schema.hpp"

namespace fathom::config {

using namespace estimation;

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kRadPerSecond_per_degPerHour = kRadPerDeg / 3600.0;
constexpr double kPerSqrtSecond_per_perSqrtHour = 1.0 / 60.0;

}  // namespace

void describe(Schema<ImuConfig>& s) {
  using C = ImuConfig;
  s.field("rate_convention", &C::rate_convention, "what a rate without increments means")
      .words({{"interval_mean", RateConvention::interval_mean}, {"point", RateConvention::point}});
  s.field("mounting_rpy_deg", &C::mounting_rpy_rad, "roll, pitch, yaw of the unit's axes in the body frame")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("nominal_rate_hz", &C::nominal_rate_hz,
          "expected rate: sizes the history and the output's deadline")
      .unit("Hz")
      .range(1, 2000);
  s.field("angle_random_walk_deg_sqrt_h", &C::angle_random_walk_rad_sqrt_s, "gyro white noise")
      .unit("deg/sqrt(h)")
      .range(1e-6, 1000)
      .scaled(kRadPerDeg * kPerSqrtSecond_per_perSqrtHour);
  s.field("velocity_random_walk_m_s_sqrt_h", &C::velocity_random_walk_m_s_sqrt_s, "accelerometer white noise")
      .unit("m/s/sqrt(h)")
      .range(1e-6, 600)
      .scaled(kPerSqrtSecond_per_perSqrtHour);
  s.field("gyro_bias_sigma_deg_h", &C::gyro_bias_sigma_rad_s, "turn-on bias")
      .unit("deg/h")
      .range(1e-6, 1e5)
      .scaled(kRadPerSecond_per_degPerHour);
  s.field("gyro_bias_instability_deg_h", &C::gyro_bias_instability_rad_s, "steady state of the in-run drift")
      .unit("deg/h")
      .range(0, 1e5)
      .scaled(kRadPerSecond_per_degPerHour);
  s.field("gyro_bias_time_constant_s", &C::gyro_bias_time_constant_s, "of the in-run drift")
      .unit("s")
      .range(1, 1e9);
  s.field("accel_bias_sigma_m_s2", &C::accel_bias_sigma_m_s2, "turn-on bias").unit("m/s^2").range(1e-9, 10);
  s.field("accel_bias_instability_m_s2", &C::accel_bias_instability_m_s2, "steady state of the in-run drift")
      .unit("m/s^2")
      .range(0, 10);
  s.field("accel_bias_time_constant_s", &C::accel_bias_time_constant_s, "of the in-run drift")
      .unit("s")
      .range(1, 1e9);
  s.field("gyro_bias_settling_deg_h", &C::gyro_bias_settling_rad_s,
          "what the biases move by while the unit settles after navigation has begun; 0: settled")
      .unit("deg/h")
      .range(0, 1e5)
      .scaled(kRadPerSecond_per_degPerHour);
  s.field("accel_bias_settling_m_s2", &C::accel_bias_settling_m_s2, "likewise of the accelerometers")
      .unit("m/s^2")
      .range(0, 10);
  s.field("bias_settling_time_s", &C::bias_settling_time_s, "how fast that dies out")
      .unit("s")
      .range(0.1, 1e6);
  s.field("gyro_scale_sigma", &C::gyro_scale_sigma, "scale error, a ratio").range(0, 0.1);
  s.field("accel_scale_sigma", &C::accel_scale_sigma, "scale error, a ratio").range(0, 0.1);
  s.field("gyro_misalignment_sigma_deg", &C::gyro_misalignment_sigma_rad, "between the axes")
      .unit("deg")
      .range(0, 5)
      .scaled(kRadPerDeg);
  s.field("accel_misalignment_sigma_deg", &C::accel_misalignment_sigma_rad, "between the axes")
      .unit("deg")
      .range(0, 5)
      .scaled(kRadPerDeg);
  s.field("equivalent_noise_time_s", &C::equivalent_noise_time_s,
          "correlation time of scale and misalignment errors that are not estimated")
      .unit("s")
      .range(0, 100);
  s.field("max_rate_deg_s", &C::max_rate_rad_s, "larger readings are out of range")
      .unit("deg/s")
      .range(6, 57'000)
      .scaled(kRadPerDeg);
  s.field("max_specific_force_m_s2", &C::max_specific_force_m_s2, "larger readings are out of range")
      .unit("m/s^2")
      .range(15, 1e5);
  s.field("max_gap_s", &C::max_gap_s, "longer gaps widen the uncertainty").unit("s").range(1e-3, 10);
  s.field("lost_gap_s", &C::lost_gap_s, "after longer gaps the attitude is lost").unit("s").range(1e-3, 3600);
  s.field("gap_rate_sigma_deg_s", &C::gap_rate_sigma_rad_s, "turning assumed possible in a gap")
      .unit("deg/s")
      .range(0, 570)
      .scaled(kRadPerDeg);
  s.field("gap_acceleration_sigma_m_s2", &C::gap_acceleration_sigma_m_s2,
          "acceleration assumed possible in a gap")
      .unit("m/s^2")
      .range(0, 100);
}

void describe(Schema<AlignmentConfig>& s) {
  using C = AlignmentConfig;
  s.field("heading_source", &C::heading_source, "where the first heading comes from")
      .words({{"automatic", HeadingSource::automatic},
              {"compass", HeadingSource::compass},
              {"given", HeadingSource::given},
              {"gyrocompass", HeadingSource::gyrocompass},
              {"two_antenna", HeadingSource::two_antenna}});
  s.field("given_heading_deg", &C::given_heading_rad, "for heading_source \"given\"")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("given_heading_sigma_deg", &C::given_heading_sigma_rad, "of it")
      .unit("deg")
      .range(1e-3, 180)
      .scaled(kRadPerDeg);
  s.field("averaging_s", &C::averaging_s, "window of levelling").unit("s").range(0.5, 3600);
  s.field("rate_spread_deg_s", &C::rate_spread_rad_s,
          "at rest: standard deviation of each rate in the window below")
      .unit("deg/s")
      .range(1e-4, 570)
      .scaled(kRadPerDeg);
  s.field("force_spread_m_s2", &C::force_spread_m_s2,
          "at rest: standard deviation of each specific force below")
      .unit("m/s^2")
      .range(1e-5, 100);
  s.field("max_speed_m_s", &C::max_speed_m_s, "at rest: GPS speed below").unit("m/s").range(1e-3, 100);
  s.field("rest_velocity_sigma_m_s", &C::rest_velocity_sigma_m_s, "of the velocity zero taken at the end")
      .unit("m/s")
      .range(1e-4, 10);
  s.field("tilt_sigma_floor_deg", &C::tilt_sigma_floor_rad, "levelling is not believed to be better")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("compass_sigma_deg", &C::compass_sigma_rad, "of a heading taken from a compass, deviation included")
      .unit("deg")
      .range(1e-3, 180)
      .scaled(kRadPerDeg);
  s.field("gyrocompass_limit_deg", &C::gyrocompass_limit_rad, "coarsest gyrocompass heading that is accepted")
      .unit("deg")
      .range(1e-3, 180)
      .scaled(kRadPerDeg);
  s.field("in_motion_speed_m_s", &C::in_motion_speed_m_s, "course over ground is a heading above")
      .unit("m/s")
      .range(0.1, 1000);
  s.field("in_motion_heading_sigma_deg", &C::in_motion_heading_sigma_rad, "of that heading")
      .unit("deg")
      .range(0.01, 180)
      .scaled(kRadPerDeg);
  s.field("in_motion_tilt_sigma_deg", &C::in_motion_tilt_sigma_rad, "of roll and pitch levelled in motion")
      .unit("deg")
      .range(0.01, 57)
      .scaled(kRadPerDeg);
  s.field("in_motion_averaging_s", &C::in_motion_averaging_s, "window of levelling in motion")
      .unit("s")
      .range(0.1, 600);
  s.field("aligned_tilt_sigma_deg", &C::aligned_tilt_sigma_rad, "aligned: roll and pitch known to")
      .unit("deg")
      .range(1e-4, 57)
      .scaled(kRadPerDeg);
  s.field("aligned_heading_sigma_deg", &C::aligned_heading_sigma_rad, "aligned: heading known to")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg);
  s.field("aligned_hold_s", &C::aligned_hold_s, "for this long").unit("s").range(0, 600);
  s.field("timeout_s", &C::timeout_s, "waiting and averaging longer is reported as timed out")
      .unit("s")
      .range(1, 1e6);
  s.field("position_given", &C::position_given, "start at the given position when no GPS fix is at hand");
  s.field("given_latitude_deg", &C::given_latitude_rad, "for position_given")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg);
  s.field("given_longitude_deg", &C::given_longitude_rad, "for position_given")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("given_altitude_m", &C::given_altitude_m,
          "for position_given: height above the WGS-84 ellipsoid, up")
      .unit("m")
      .range(-12'000, 100'000);
  s.field("position_sigma_m", &C::position_sigma_m, "floor of a start position taken from GPS")
      .unit("m")
      .range(1e-3, 1e4);
}

void describe(Schema<NonHolonomicConfig>& s) {
  using C = NonHolonomicConfig;
  s.field("enabled", &C::enabled, "the vehicle runs on wheels: no velocity sideways and upwards");
  s.field("rate_hz", &C::rate_hz, "how often it is applied").unit("Hz").range(0.01, 1000);
  s.field("lever_B_m", &C::lever_B_m, "from the inertial unit to the point where it holds, the rear axle")
      .unit("m")
      .range(-1000, 1000);
  s.field("mounting_rpy_deg", &C::mounting_rpy_rad, "roll, pitch, yaw of the wheels' axes in the body frame")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("lateral_sigma_m_s", &C::lateral_sigma_m_s, "sideways").unit("m/s").range(1e-5, 1e3);
  s.field("vertical_sigma_m_s", &C::vertical_sigma_m_s, "upwards").unit("m/s").range(1e-5, 1e3);
  s.field("slip_time_s", &C::slip_time_s,
          "for which slip and bounce last; 0: the sigmas are noise of each time")
      .unit("s")
      .range(0, 1000);
}

void describe(Schema<ConstantDepthConfig>& s) {
  using C = ConstantDepthConfig;
  s.field("enabled", &C::enabled, "the vehicle keeps its depth: no velocity down");
  s.field("rate_hz", &C::rate_hz, "how often it is applied").unit("Hz").range(0.01, 1000);
  s.field("sigma_m_s", &C::sigma_m_s, "of the heave").unit("m/s").range(1e-5, 1e3);
}

void describe(Schema<ConstraintsConfig>& s) {
  s.field("non_holonomic", &ConstraintsConfig::non_holonomic, "wheels");
  s.field("constant_depth", &ConstraintsConfig::constant_depth, "level flight of a body in water");
}

void describe(Schema<ForecastLimitConfig>& s) {
  s.field("name", &ForecastLimitConfig::name,
          "one that begins with \"heading\" limits the heading, others the position")
      .name()
      .required();
  s.field("limit", &ForecastLimitConfig::limit, "of the 95 % uncertainty: m, or rad for a heading")
      .range(1e-6, 1e7)
      .required();
}

void describe(Schema<EngineConfig>& s) {
  using C = EngineConfig;
  s.field("configuration", &C::configuration, "named set of estimated states")
      .words({{"gps_ins15", "gps_ins15"},
              {"gps_ins24", "gps_ins24"},
              {"gps_ins36", "gps_ins36"},
              {"standard", "standard"},
              {"hybrid25", "hybrid25"},
              {"full", "full"}});
  s.field("groups", &C::groups, "state groups switched on or off against the named set");
  s.field("imu", &C::imu, "error model of the inertial unit").required();
  s.field("states", &C::states, "initial uncertainty and drift of the states beyond the core");
  s.field("sensors", &C::sensors, "aiding instruments; one that is not listed is never used").required();
  s.field("alignment", &C::alignment, "finding the attitude");
  s.field("air_drop", &C::air_drop, "finding roll and pitch under way after a drop");
  s.field("vehicle_model", &C::vehicle_model,
          "the vehicle's own dynamics as a virtual velocity log, for when the DVL is lost");
  s.field("constraints", &C::constraints, "what is known about the motion without an instrument");
  s.field("horizon_s", &C::horizon_s, "measurements up to this late count as punctual ones")
      .unit("s")
      .range(0.1, 60);
  s.field("snapshot_interval_s", &C::snapshot_interval_s,
          "a roll-back repeats at most this much more than it must")
      .unit("s")
      .range(0.01, 60);
  s.field("replay_steps_per_sample", &C::replay_steps_per_sample,
          "steps that one inertial sample repeats for late measurements; what needs more is spread over the "
          "next")
      .range(2, 1e6);
  s.field("future_tolerance_s", &C::future_tolerance_s,
          "stamps further ahead of the inertial ones are refused")
      .unit("s")
      .range(0, 60);
  s.field("measurement_capacity", &C::measurement_capacity, "measurements remembered within the horizon")
      .range(64, 65'535);
  s.field("magnetic_variation_known", &C::magnetic_variation_known, "magnetic_variation_deg is to be used");
  s.field("magnetic_variation_deg", &C::magnetic_variation_rad,
          "east positive, where the compass reports none")
      .unit("deg")
      .range(-180, 180)
      .scaled(kRadPerDeg);
  s.field("gps_timeout_s", &C::gps_timeout_s, "mode leaves gps_aided after").unit("s").range(0.1, 1e5);
  s.field("usbl_timeout_s", &C::usbl_timeout_s, "mode leaves acoustic_aided after").unit("s").range(0.1, 1e5);
  s.field("velocity_timeout_s", &C::velocity_timeout_s, "mode leaves dead_reckoning after")
      .unit("s")
      .range(0.1, 1e5);
  s.field("zero_velocity_sigma_m_s", &C::zero_velocity_sigma_m_s, "while marked at rest")
      .unit("m/s")
      .range(1e-5, 10);
  s.field("output_lever_B_m", &C::output_lever_B_m,
          "from the inertial unit to the point whose position and velocity are published")
      .unit("m")
      .range(-1000, 1000);
  s.field("output_axes", &C::output_axes,
          "whose attitude, rate and force are published: the body's, or, where constraints.non_holonomic is "
          "enabled, those of the wheels with the mount angles that were found")
      .words({{"body", OutputAxes::body}, {"wheels", OutputAxes::wheels}});
  s.field("forecast_span_s", &C::forecast_span_s, "how far the forecast looks").unit("s").range(1, 7200);
  s.field("forecast_limits", &C::forecast_limits, "what the forecast watches, at most 8");
  s.check([](const EngineConfig& config) -> std::pair<std::string, std::string> {
    // The estimator's own rules, across fields; its complaint reads "key: value: expectation".
    const std::string complaint = config.validate();
    if (complaint.empty()) return {};
    const auto colon = complaint.find(": ");
    const auto last = complaint.rfind(": expected ");
    if (last == std::string::npos) return {complaint.substr(0, colon), complaint.substr(colon + 2)};
    return {complaint.substr(0, colon), complaint.substr(last + 11)};
  });
}

void load_value(const nlohmann::json& json, EngineConfig& out, const Rules<EngineConfig>&,
                const Place& place) {
  if (json.is_object() && json.contains("configuration") && json.at("configuration").is_string()) {
    static_cast<void>(named_state_groups(json.at("configuration").get<std::string>(), out.groups));
  }
  schema_of<EngineConfig>().load(json, out, place);
}

}  // namespace fathom::config

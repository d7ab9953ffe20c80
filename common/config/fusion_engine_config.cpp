#include <numbers>
#include <string>

#include "config/engine_schema.hpp"

namespace fathom::config {

using namespace estimation;

namespace {

constexpr double kRadPerDeg = std::numbers::pi / 180.0;
constexpr double kRadPerSecond_per_degPerHour = kRadPerDeg / 3600.0;
constexpr double kPerSqrtSecond_per_perSqrtHour = 1.0 / 60.0;

const std::vector<std::pair<std::string, SourceKind>>& aiding_kinds() {
  static const std::vector<std::pair<std::string, SourceKind>> kinds{{"gps", SourceKind::gps},
                                                                     {"dvl", SourceKind::dvl},
                                                                     {"depth", SourceKind::depth},
                                                                     {"heading", SourceKind::heading},
                                                                     {"usbl", SourceKind::usbl},
                                                                     {"airspeed", SourceKind::airspeed},
                                                                     {"propulsion", SourceKind::propulsion},
                                                                     {"fins", SourceKind::fins}};
  return kinds;
}

// The key that states a sensor's noise in the unit of what it measures.
std::string sigma_key(SourceKind kind) {
  switch (kind) {
    case SourceKind::heading:
      return "sigma_deg";
    case SourceKind::dvl:
    case SourceKind::airspeed:
    case SourceKind::propulsion:
      return "sigma_m_s";
    default:
      return "sigma_m";
  }
}

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

void describe(Schema<SensorConfig>& s) {
  using C = SensorConfig;
  s.field("sensor", &C::sensor, "name in the instrument's samples").required();
  s.field("kind", &C::kind, "what it measures").words(aiding_kinds()).required();
  s.field("enabled", &C::enabled, "false: its samples are judged source_disabled");
  s.field("lever_B_m", &C::lever_B_m,
          "from the inertial unit to the instrument, forward, right, down; must be given for gps, dvl, "
          "depth, usbl")
      .unit("m")
      .range(-1000, 1000);
  s.field(
       "mounting_rpy_deg", &C::mounting_rpy_rad,
       "roll, pitch, yaw of the instrument's axes in the body frame, of a usbl transceiver in its ship; must "
       "be given for dvl")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("latency_s", &C::latency_s, "subtracted from the stamp").unit("s").range(-10, 60);
  s.field("sigma_m", &C::sigma, "noise: gps and usbl north, east, down; depth and usbl range in the first")
      .unit("m")
      .range(1e-6, 1e6);
  s.field("sigma_m_s", &C::sigma, "noise: dvl and propulsion x, y, z; airspeed in the first")
      .unit("m/s")
      .range(1e-6, 1e6);
  s.field("sigma_deg", &C::sigma, "noise: heading in the first")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg);
  s.field("velocity_sigma_m_s", &C::velocity_sigma_m_s, "noise of the GPS velocity north, east, down")
      .unit("m/s")
      .range(1e-6, 1e3);
  s.field("proportional_sigma", &C::proportional_sigma, "added to the noise times the magnitude measured")
      .range(0, 10);
  s.field("use_sample_sigma", &C::use_sample_sigma, "a larger figure in the sample counts");
  s.field("use_position", &C::use_position, "gps");
  s.field("use_velocity", &C::use_velocity, "gps");
  s.field("min_fix", &C::min_fix,
          "gps: lowest quality used: 3 2D, 4 3D, 5 differential, 6 RTK float, 7 RTK fixed")
      .range(0, 7);
  s.field("refuse_spoofed", &C::refuse_spoofed,
          "gps: a fix of which the receiver itself affirms that it is spoofed is out of range");
  s.field("gate_probability", &C::gate_probability,
          "share of good measurements that pass the gate; 1: no gate")
      .range(0.5, 1.0);
  s.field("gate_mode", &C::gate_mode, "judge a measurement as a whole or each component")
      .words({{"whole", GateMode::whole}, {"per_component", GateMode::per_component}});
  s.field("robust", &C::robust, "weigh doubtful measurements down instead of refusing them")
      .words(
          {{"none", RobustKind::none}, {"huber", RobustKind::huber}, {"student_t", RobustKind::student_t}});
  s.field("robust_parameter", &C::robust_parameter,
          "student_t: degrees of freedom; huber: threshold in sigmas")
      .range(0.1, 1e3);
  s.field("robust_reject_ratio", &C::robust_reject_ratio,
          "a robustly weighted measurement is refused all the same above this plain test ratio")
      .range(1, 1e9);
  s.field("reacquire_s", &C::reacquire_s, "consistent rejections for this long are believed")
      .unit("s")
      .range(0, 1e6);
  s.field("reacquire_step_m", &C::reacquire_step_m,
          "GPS: behind an outage a fix further off than this has to agree with the motion for reacquire_s "
          "first, "
          "and no fix moves the position by more than twice this at once")
      .unit("m")
      .range(0.1, 1e6);
  s.field(
       "frozen_change", &C::frozen_change,
       "the same reading while the prediction moves by this much is frozen, in the sensor's SI unit; 0: off")
      .range(0, 1e6);
  s.field(
      "two_antenna", &C::two_antenna,
      "heading: from two GPS antennas, mounting_rpy_deg being the direction from the rear one to the front "
      "one; its own sigma counts at the start, the compass's states do not apply to it");
  s.field("angle_sigma_deg", &C::angle_sigma_rad, "usbl: noise of a direction, across it")
      .unit("deg")
      .range(1e-4, 180)
      .scaled(kRadPerDeg);
  s.field("transceiver_known", &C::transceiver_known,
          "usbl: the transceiver, or the beacon that the vehicle's own transceiver looks at, is at the place "
          "that follows; a place that comes with the fix goes before it");
  s.field("transceiver_latitude_deg", &C::transceiver_latitude_rad, "usbl: for transceiver_known")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg);
  s.field("transceiver_longitude_deg", &C::transceiver_longitude_rad, "usbl: for transceiver_known")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("transceiver_depth_m", &C::transceiver_depth_m,
          "usbl: for transceiver_known and for fixes that come with a place but no depth, below the surface")
      .unit("m")
      .range(-1000, 12'000);
  s.field(
       "sideslip_sigma_deg", &C::sideslip_sigma_rad,
       "airspeed: the aircraft flies straight into the air but for its sideslip state and this; 0: not used")
      .unit("deg")
      .range(0, 57)
      .scaled(kRadPerDeg);
  s.field("attack_sigma_deg", &C::attack_sigma_rad, "airspeed: likewise the angle of attack; 0: not used")
      .unit("deg")
      .range(0, 57)
      .scaled(kRadPerDeg);
  s.field("baro_sigma_m", &C::baro_sigma_m,
          "airspeed: noise of the barometric height in its samples; 0: not used")
      .unit("m")
      .range(0, 1e4);
  s.field("use_beams", &C::use_beams,
          "dvl: each beam on its own, one to four of them, where the sample carries them");
  s.field("beam_angle_deg", &C::beam_angle_rad,
          "dvl: of the beams from the instrument's down axis, where the sample does not say")
      .unit("deg")
      .range(3, 80)
      .scaled(kRadPerDeg);
  s.field("beam_azimuth_deg", &C::beam_azimuth_rad,
          "dvl: where each of the four beams points, from forward towards right")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("scale_m_s_per_rpm", &C::scale_m_s_per_rpm, "propulsion: water speed per shaft speed; 0: not used")
      .unit("m/s/rpm")
      .range(-10, 10);
  s.field("min_depth_m", &C::min_depth_m, "propulsion: shaft speed means nothing above it")
      .unit("m")
      .range(-1000, 12'000);
  s.field("slip_time_s", &C::slip_time_s,
          "propulsion: for which slip along and across lasts; 0: noise of a sample")
      .unit("s")
      .range(0, 1000);
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

void load_value(const nlohmann::json& json, SensorConfig& out, const Rules<SensorConfig>&,
                const Place& place) {
  if (!json.is_object()) place.fail(json, "an object");
  SourceKind kind = SourceKind::gps;
  if (!json.contains("kind")) place.child("kind").fail_missing("what the instrument measures");
  load_value(json.at("kind"), kind, Rules<SourceKind>{.words = aiding_kinds()}, place.child("kind"));
  out = default_sensor(kind, "");
  const bool lever = kind == SourceKind::gps || kind == SourceKind::dvl || kind == SourceKind::depth ||
                     kind == SourceKind::usbl;
  if (lever && !json.contains("lever_B_m")) {
    place.child("lever_B_m")
        .fail_missing("the instrument's place from the inertial unit, forward, right, down in m");
  }
  if (kind == SourceKind::dvl && !json.contains("mounting_rpy_deg")) {
    place.child("mounting_rpy_deg")
        .fail_missing("roll, pitch, yaw of the instrument's axes in the body frame in deg");
  }
  for (const char* key : {"sigma_m", "sigma_m_s", "sigma_deg"}) {
    if (json.contains(key) && key != sigma_key(kind)) {
      place.child(key).fail(json.at(key), "the key " + sigma_key(kind) + " for this kind");
    }
  }
  schema_of<SensorConfig>().load(json, out, place);
}

void load_value(const nlohmann::json& json, EngineConfig& out, const Rules<EngineConfig>&,
                const Place& place) {
  if (json.is_object() && json.contains("configuration") && json.at("configuration").is_string()) {
    static_cast<void>(named_state_groups(json.at("configuration").get<std::string>(), out.groups));
  }
  schema_of<EngineConfig>().load(json, out, place);
}

}  // namespace fathom::config

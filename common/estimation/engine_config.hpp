#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "estimation/alignment/drop_config.hpp"
#include "estimation/hydro/coefficients.hpp"
#include "samples/verdict.hpp"

namespace fathom::estimation {

/// What an IMU sample without increments means.
enum class RateConvention : std::uint8_t {
  interval_mean = 0,  ///< rates averaged over the interval that ends at the stamp
  point = 1,          ///< rates at the stamp: integrated by the trapezoidal rule
};

/// Error model of the inertial unit. All sigmas are one standard deviation of one axis.
struct ImuConfig {
  RateConvention rate_convention = RateConvention::interval_mean;
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};  ///< attitude of the unit's axes in the body frame B
  double nominal_rate_hz = 100.0;                   ///< sizes the history
  double angle_random_walk_rad_sqrt_s = 2.9e-5;     ///< 0.1 deg/sqrt(h)
  double velocity_random_walk_m_s_sqrt_s = 5.0e-4;  ///< 50 ug/sqrt(Hz)
  double gyro_bias_sigma_rad_s = 4.85e-6;           ///< turn-on, 1 deg/h
  double gyro_bias_instability_rad_s = 1.45e-6;     ///< in-run, steady state of its Gauss-Markov process
  double gyro_bias_time_constant_s = 3600.0;
  double accel_bias_sigma_m_s2 = 9.8e-3;  ///< turn-on, 1 mg
  double accel_bias_instability_m_s2 = 2.9e-3;
  double accel_bias_time_constant_s = 3600.0;
  /// What the biases move by while the unit settles, beyond the in-run drift, and how fast that dies out
  /// after navigation has begun: warming up, or a filter inside the instrument that still changes its
  /// corrections.
  double gyro_bias_settling_rad_s = 0.0;
  double accel_bias_settling_m_s2 = 0.0;  ///< likewise
  double bias_settling_time_s = 60.0;
  double gyro_scale_sigma = 300e-6;            ///< used where the state group is on, else as equivalent noise
  double accel_scale_sigma = 300e-6;           ///< likewise
  double gyro_misalignment_sigma_rad = 3e-4;   ///< likewise
  double accel_misalignment_sigma_rad = 3e-4;  ///< likewise
  double equivalent_noise_time_s = 1.0;      ///< correlation time of unmodelled scale and misalignment error
  double max_rate_rad_s = 35.0;              ///< larger readings are out of range
  double max_specific_force_m_s2 = 400.0;    ///< likewise
  double max_gap_s = 0.25;                   ///< longer gaps widen the uncertainty
  double lost_gap_s = 10.0;                  ///< after longer gaps the attitude is lost
  double gap_rate_sigma_rad_s = 0.05;        ///< motion assumed possible in a gap
  double gap_acceleration_sigma_m_s2 = 1.0;  ///< likewise
};

/// Which error states are estimated. The named configurations fill it; single groups may then be switched.
struct StateGroups {
  bool accel_scale = false;         ///< 3
  bool gyro_scale = false;          ///< 3
  bool accel_misalignment = false;  ///< 6
  bool gyro_misalignment = false;   ///< 6
  bool dvl_scale = false;           ///< 1, common to all axes
  bool dvl_scale_xyz = false;       ///< 3, excludes dvl_scale
  bool dvl_misalignment = false;    ///< 3
  bool dvl_bias = false;            ///< 3
  bool current = false;             ///< 2, north and east velocity of the medium (water, or air for airspeed)
  bool depth_bias = false;          ///< 1
  bool surface_altitude = false;    ///< 1, ellipsoidal height of the water surface
  bool heading_bias = false;        ///< 1
  bool heading_deviation = false;   ///< 4, B to E of the deviation curve
  bool usbl_bias = false;           ///< 2, north and east
  bool usbl_misalignment = false;   ///< 3, of the transceiver's axes
  bool gps_position_bias = false;   ///< 3, Gauss-Markov
  bool gps_latency = false;         ///< 1, beyond SensorConfig::latency_s
  bool gps_lever = false;           ///< 3, beyond SensorConfig::lever_B_m
  bool log_scale = false;           ///< 1, of the speed log made from propulsor speed
  bool airspeed_bias = false;       ///< 1
  bool airspeed_scale = false;      ///< 1
  bool flow_angles = false;         ///< 2, sideslip and angle of attack, Gauss-Markov
  bool baro_bias = false;           ///< 1, barometric height less ellipsoidal height
  bool mount_angles = false;        ///< 2, pitch and yaw of the wheels' axes beyond the configured ones
  bool mount_lever = false;         ///< 3, beyond the configured place of the non-holonomic constraint
  bool model_scale = false;         ///< 2, share by which the vehicle model errs, ahead and across
  bool model_bias = false;          ///< 2, of the vehicle model's velocity, ahead and across, Gauss-Markov
};

/// The groups of a named configuration: "gps_ins15"; "gps_ins24", with scale factors and the slow error of
/// GPS; "gps_ins36", with misalignments, too; "standard", "hybrid25", "full".
/// False when there is no such name.
[[nodiscard]] bool named_state_groups(const std::string& name, StateGroups& groups);

/// Initial sigmas and drift of the states beyond the core.
struct StateModelConfig {
  double dvl_scale_sigma = 0.004;
  double dvl_misalignment_sigma_rad = 0.0087;  ///< 0.5 deg
  double dvl_bias_sigma_m_s = 0.004;
  double current_sigma_m_s = 0.5;
  double current_time_constant_s = 1800.0;  ///< 0: it does not change
  double depth_bias_sigma_m = 0.1;
  double surface_altitude_m = 0.0;  ///< value when the state group is off
  double surface_altitude_sigma_m = 100.0;
  double surface_altitude_walk_m_sqrt_s = 1e-3;  ///< tide: 6 cm in an hour
  double heading_bias_sigma_rad = 0.0175;
  double heading_bias_time_constant_s = 1800.0;  ///< deviation changes with course; 0 for a constant
  double heading_deviation_sigma_rad = 0.035;
  double usbl_bias_sigma_m = 2.0;
  double usbl_misalignment_sigma_rad = 0.0087;  ///< 0.5 deg
  double gps_bias_sigma_m = 1.5;                ///< horizontal; vertical is twice it
  double gps_bias_time_constant_s = 300.0;
  double gps_latency_sigma_s = 0.05;
  double gps_lever_sigma_m = 0.2;
  double log_scale_sigma = 0.02;
  double airspeed_bias_sigma_m_s = 1.5;
  double airspeed_scale_sigma = 0.1;
  double flow_angle_sigma_rad = 0.05;
  double flow_angle_time_constant_s = 5.0;
  double baro_bias_sigma_m = 100.0;
  double baro_bias_walk_m_sqrt_s = 0.05;  ///< weather and the instrument's own drift
  double mount_angle_sigma_rad = 0.035;
  double mount_lever_sigma_m = 1.0;
  double model_scale_sigma = 0.2;
  double model_bias_sigma_m_s = 0.01;
  double model_bias_time_constant_s = 120.0;
};

enum class GateMode : std::uint8_t { whole = 0, per_component = 1 };
enum class RobustKind : std::uint8_t { none = 0, huber = 1, student_t = 2 };

/// One instrument that may aid, keyed by the sensor name in its samples. A sensor that is not listed is never
/// used: its samples get the verdict source_disabled.
struct SensorConfig {
  std::string sensor;  ///< e.g. "dvl0"
  SourceKind kind = SourceKind::gps;
  bool enabled = true;
  std::array<double, 3> lever_B_m{0, 0, 0};         ///< from the IMU to the instrument, along B
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};  ///< attitude of the instrument's axes in B; in the ship
                                                    ///< that carries a USBL transceiver
  double latency_s = 0.0;                           ///< subtracted from the stamp
  /// Noise of each component: GPS position and USBL m (N, E, D), DVL m/s (x, y, z), speed log m/s (x, y, z),
  /// depth m, heading rad, airspeed m/s in the first. A figure carried by the sample counts when larger.
  std::array<double, 3> sigma{1.0, 1.0, 1.0};
  std::array<double, 3> velocity_sigma_m_s{0.1, 0.1, 0.1};  ///< GPS velocity (N, E, D)
  double proportional_sigma = 0.0;                          ///< added to sigma times the magnitude measured
  bool use_sample_sigma = true;
  bool use_position = true;         ///< GPS
  bool use_velocity = true;         ///< GPS
  std::uint8_t min_fix = 4;         ///< GPS: lowest GpsFix that counts (4: fix_3d)
  bool refuse_spoofed = true;       ///< GPS: not used while the receiver says that it is spoofed
  double gate_probability = 0.999;  ///< share of good measurements that pass; 1: no gate
  GateMode gate_mode = GateMode::whole;
  RobustKind robust = RobustKind::none;
  double robust_parameter = 5.0;      ///< student_t: degrees of freedom; huber: threshold in sigmas
  double robust_reject_ratio = 25.0;  ///< robust weighting ends where the plain test ratio exceeds this
  double reacquire_s = 10.0;          ///< consistent rejections for this long are believed
  /// GPS: fixes that the estimate's own uncertainty cannot explain are believed after this much agreement; 0:
  /// never, a person has to decide.
  double dispute_s = 600.0;
  /// GPS: behind an outage a fix further off than this is on probation for reacquire_s though the gate would
  /// pass it, and no fix moves the position by more than twice this at once; m.
  double reacquire_step_m = 50.0;
  double frozen_change = 0.0;  ///< the same reading while the prediction moves by this much is frozen; 0: off
  /// Heading: from two GPS antennas. Its sigma is believed at the start, and no deviation curve is its.
  bool two_antenna = false;
  double angle_sigma_rad = 0.0087;  ///< USBL: of a direction, across it
  /// USBL: the place that follows is that of the transceiver, or of the beacon that the vehicle's own
  /// transceiver looks at; a place that comes with the sample goes before it.
  bool transceiver_known = false;
  double transceiver_latitude_rad = 0.0;
  double transceiver_longitude_rad = 0.0;
  double transceiver_depth_m = 0.0;  ///< below the water surface, down; also where the sample has no depth
  double sideslip_sigma_rad = 0.0;   ///< airspeed: sideslip beyond its state; 0: nothing is known of it
  double attack_sigma_rad = 0.0;     ///< airspeed: likewise the angle of attack
  double gust_time_s = 0.0;   ///< airspeed: for which a gust lasts, along and across; 0: noise of a sample
  double baro_sigma_m = 0.0;  ///< airspeed: of the barometric height in its samples; 0: not used
  bool use_beams = false;     ///< DVL: the beams each on their own, where the sample carries them
  double beam_angle_rad = 0.5235987755982988;  ///< DVL: of the beams from the down axis, where the sample
                                               ///< does not say; 30 deg
  /// DVL: where each beam points, from forward towards right. Default: 1 left, 2 right, 3 ahead, 4 astern.
  std::array<double, 4> beam_azimuth_rad{-1.5707963267948966, 1.5707963267948966, 0.0, 3.141592653589793};
  double scale_m_s_per_rpm = 0.0;  ///< propulsion: water speed per shaft rpm; 0: not used
  double min_depth_m = 0.0;        ///< propulsion: shaft speed means nothing above it
  double slip_time_s = 10.0;  ///< propulsion: for which slip along and across lasts; 0: noise of a sample
};

/// A sensor with the defaults that suit its kind.
[[nodiscard]] SensorConfig default_sensor(SourceKind kind, const std::string& name);

enum class StartMode : std::uint8_t {
  at_rest = 0,    ///< level, then take a heading, where the vehicle lies
  in_motion = 1,  ///< from GPS velocity
  given = 2,      ///< start_from() or the configured state
  automatic = 3,  ///< at rest or in motion, whichever the instruments show first
  air_drop = 4,   ///< start_from() at the release with roll and pitch unknown; alignment under way in water
};
enum class HeadingSource : std::uint8_t {
  automatic = 0,  ///< two antennas, else compass, else gyrocompass where the gyro allows
  compass = 1,
  given = 2,  ///< given_heading_rad
  gyrocompass = 3,
  two_antenna = 4,  ///< a heading sensor with two_antenna set
};

struct AlignmentConfig {
  StartMode mode = StartMode::automatic;
  HeadingSource heading_source = HeadingSource::automatic;
  double given_heading_rad = 0.0;
  double given_heading_sigma_rad = 0.0175;
  double averaging_s = 8.0;         ///< window of levelling
  double rate_spread_rad_s = 0.05;  ///< at rest: standard deviation of each rate in the window below this
  double force_spread_m_s2 = 0.5;   ///< likewise of the specific force
  double max_speed_m_s = 0.7;       ///< at rest: GPS speed below this
  double rest_velocity_sigma_m_s = 0.3;  ///< of the velocity zero taken at the end
  double tilt_sigma_floor_rad = 2e-3;
  double compass_sigma_rad = 0.026;     ///< of the heading taken from a compass, deviation included
  double gyrocompass_limit_rad = 0.09;  ///< coarsest gyrocompass heading that is accepted
  double in_motion_speed_m_s = 3.0;     ///< course is a heading above this
  double in_motion_heading_sigma_rad = 0.17;
  double in_motion_tilt_sigma_rad = 0.09;
  double in_motion_averaging_s = 2.0;
  double aligned_tilt_sigma_rad = 5e-3;
  double aligned_heading_sigma_rad = 0.044;
  double aligned_hold_s = 1.0;
  double timeout_s = 600.0;     ///< waiting and averaging longer than this is reported as timed_out
  bool position_given = false;  ///< start there when no GPS fix is at hand
  double given_latitude_rad = 0.0;
  double given_longitude_rad = 0.0;
  double given_altitude_m = 0.0;  ///< above the ellipsoid
  double position_sigma_m = 3.0;  ///< floor of the start position taken from GPS
};

/// A vehicle on wheels: no velocity sideways and upwards at one point of it.
struct NonHolonomicConfig {
  bool enabled = false;
  double rate_hz = 10.0;
  std::array<double, 3> lever_B_m{0, 0, 0};         ///< from the IMU to that point, along B; the rear axle
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};  ///< attitude of the wheels' axes in B
  double lateral_sigma_m_s = 0.1;
  double vertical_sigma_m_s = 0.1;
  double slip_time_s = 0.0;  ///< for which slip and bounce last; 0: noise of each application
};

/// A vehicle that keeps its depth: no velocity down.
struct ConstantDepthConfig {
  bool enabled = false;
  double rate_hz = 1.0;
  double sigma_m_s = 0.1;
};

/// What is known about the motion without an instrument; applied at a rate of its own, without verdicts.
struct ConstraintsConfig {
  NonHolonomicConfig non_holonomic;
  ConstantDepthConfig constant_depth;
};

/// The vehicle's own dynamics as a virtual velocity log, driven by the propulsor's and the fins' samples.
struct VehicleModelConfig {
  bool enabled = false;
  std::string coefficients_file;  ///< where the configuration took them from
  hydro::HydroCoefficients coefficients;
  std::array<double, 3> origin_B_m{0, 0, 0};    ///< of the coefficients, from the IMU, along B
  std::array<double, 2> sigma_m_s{0.02, 0.02};  ///< ahead, across: what is neither scale nor slow bias
  double correlation_time_s = 3.0;              ///< of that
  double fins_timeout_s = 2.0;                  ///< without fin angles the velocity across counts less
  double min_depth_m = 1.0;                     ///< the model is of the submerged vehicle
  double settle_s = 30.0;                       ///< not used before: what was wrong at its start dies out
  double memory_s = 60.0;                       ///< over which it is compared with the DVL-aided velocity
  double trial_s = 30.0;                        ///< of comparison before it is believed without the DVL
  double doubt_limit = 9.0;  ///< mean normalised squared innovation above which it is not believed
};

/// Whose attitude, rate and force are published.
enum class OutputAxes : std::uint8_t {
  body = 0,    ///< B, as the configuration mounts the inertial unit in it
  wheels = 1,  ///< those of the non-holonomic constraint with the mount angles found: where the vehicle goes;
               ///< without the constraint nothing finds them, and it is B
};

/// A limit that the forecast watches.
struct ForecastLimitConfig {
  std::string name;      ///< e.g. "horizontal_100m"
  double limit = 100.0;  ///< m; rad when name begins with "heading"
};

struct EngineConfig {
  std::string vehicle = "auv";
  std::string sensor = "fusion";           ///< header.sensor of what the engine says
  std::string configuration = "standard";  ///< name that goes into NavDetail
  StateGroups groups;                      ///< the default is that of "standard", see EngineConfig()
  ImuConfig imu;
  StateModelConfig states;
  std::vector<SensorConfig> sensors;
  AlignmentConfig alignment;
  DropConfig air_drop;  ///< for StartMode::air_drop; what start_from() and the sensors say goes before it
  ConstraintsConfig constraints;
  VehicleModelConfig vehicle_model;
  double horizon_s = 5.0;            ///< measurements up to this late give the same bits as punctual ones
  double snapshot_interval_s = 0.2;  ///< a roll-back repeats at most this much more than it must
  /// Steps that one inertial sample repeats for late measurements; what needs more is spread over the next
  /// ones.
  std::uint32_t replay_steps_per_sample = 256;
  double future_tolerance_s = 0.5;  ///< stamps further ahead of the newest inertial sample are refused
  std::uint32_t measurement_capacity = 2048;  ///< measurements remembered; more within the horizon shorten it
  bool magnetic_variation_known = false;
  double magnetic_variation_rad = 0.0;  ///< east positive; used when the compass does not report its own
  double gps_timeout_s = 3.0;           ///< mode leaves gps_aided after this
  double usbl_timeout_s = 15.0;
  double velocity_timeout_s = 3.0;                  ///< mode leaves dead_reckoning after this
  double zero_velocity_sigma_m_s = 0.02;            ///< while marked at rest
  std::array<double, 3> output_lever_B_m{0, 0, 0};  ///< the point whose position and velocity NavState tells
  OutputAxes output_axes = OutputAxes::body;        ///< those whose attitude NavState tells
  double forecast_span_s = 600.0;
  std::vector<ForecastLimitConfig> forecast_limits;

  EngineConfig();
  /// Empty when everything is inside its range, else one line "key: value: what was expected".
  [[nodiscard]] std::string validate() const;
};

/// A state given from outside, e.g. by a reference, another vehicle or an operator.
struct InitialState {
  std::int64_t stamp_ns = 0;  ///< 0: whenever navigation begins
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
  std::array<double, 3> velocity_N_m_s{0, 0, 0};
  std::array<double, 3> rpy_rad{0, 0, 0};
  std::array<double, 3> position_sigma_N_m{1, 1, 1};
  std::array<double, 3> velocity_sigma_N_m_s{0.1, 0.1, 0.1};
  std::array<double, 3> attitude_sigma_rad{0.01, 0.01, 0.02};  ///< about N, E, D
  bool at_output_point = true;  ///< position and velocity are those of the output point, not of the IMU
};

}  // namespace fathom::estimation

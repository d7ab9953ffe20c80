#pragma once

// Configuration of the estimator: members and their defaults, in SI units and radians. What a member means,
// its range and its key and unit in files stand in estimation/description, once.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/field.hpp"
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
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};
  double nominal_rate_hz = 100.0;
  double max_noise_factor = 30.0;
  double angle_random_walk_rad_sqrt_s = 2.9e-5;     ///< 0.1 deg/sqrt(h)
  double velocity_random_walk_m_s_sqrt_s = 5.0e-4;  ///< 50 ug/sqrt(Hz)
  double gyro_bias_sigma_rad_s = 4.85e-6;
  double gyro_bias_instability_rad_s = 1.45e-6;
  double gyro_bias_time_constant_s = 3600.0;
  double accel_bias_sigma_m_s2 = 9.8e-3;
  double accel_bias_instability_m_s2 = 2.9e-3;
  double accel_bias_time_constant_s = 3600.0;
  double gyro_bias_settling_rad_s = 0.0;
  double accel_bias_settling_m_s2 = 0.0;
  double bias_settling_time_s = 60.0;
  double gyro_scale_sigma = 300e-6;
  double accel_scale_sigma = 300e-6;
  double gyro_misalignment_sigma_rad = 3e-4;
  double accel_misalignment_sigma_rad = 3e-4;
  double gyro_g_sensitivity_rad_s_per_m_s2 = 0.0;
  double accel_nonlinearity_sigma = 0.0;
  double equivalent_noise_time_s = 1.0;
  double max_rate_rad_s = 35.0;
  double max_specific_force_m_s2 = 400.0;
  double max_gap_s = 0.25;
  double lost_gap_s = 10.0;
  double gap_rate_sigma_rad_s = 0.05;
  double gap_acceleration_sigma_m_s2 = 1.0;
};

/// Which error states are estimated. The named configurations fill it; single groups may then be switched.
struct StateGroups {
  bool accel_scale = false;
  bool gyro_scale = false;
  bool accel_misalignment = false;
  bool gyro_misalignment = false;
  bool dvl_scale = false;
  bool dvl_scale_xyz = false;
  bool dvl_misalignment = false;
  bool dvl_bias = false;
  bool current = false;
  bool depth_bias = false;
  bool surface_altitude = false;
  bool heading_bias = false;
  bool heading_deviation = false;
  bool usbl_bias = false;
  bool usbl_misalignment = false;
  bool gps_position_bias = false;
  bool gps_latency = false;
  bool gps_lever = false;
  bool log_scale = false;
  bool airspeed_bias = false;
  bool airspeed_scale = false;
  bool flow_angles = false;
  bool baro_bias = false;
  bool mount_angles = false;
  bool mount_lever = false;
  bool model_scale = false;
  bool model_bias = false;
  bool antenna_bias = false;
  bool beacon_place = false;
};

/// What becomes of the errors of the instruments that no state is estimated for: scale and misalignment of
/// the inertial unit and of the DVL, the bias of DVL and compass, the slow error of GPS, of USBL and of a
/// heading by two antennas, and where beacons lie.
enum class LeftOut : std::uint8_t {
  considered = 0,  ///< their covariance with the states is kept, their values are not found (KF-6)
  noise = 1,       ///< those of the inertial unit enter as noise (NOISE-1), the others are taken for none
};

/// A named configuration.
struct StateConfiguration {
  const char* name;
  StateGroups groups;
};

/// All of them.
[[nodiscard]] std::span<const StateConfiguration> state_configurations();

/// The groups of a named configuration. False when there is no such name.
[[nodiscard]] bool named_state_groups(const std::string& name, StateGroups& groups);

/// Initial sigmas and drift of the states beyond the core.
struct StateModelConfig {
  double dvl_scale_sigma = 0.004;
  double dvl_misalignment_sigma_rad = 0.0087;
  double dvl_bias_sigma_m_s = 0.001;  ///< what most data sheets give beside the scale
  double current_sigma_m_s = 0.5;
  double current_time_constant_s = 1800.0;
  double depth_bias_sigma_m = 0.1;
  double surface_altitude_m = 0.0;
  double surface_altitude_sigma_m = 100.0;
  double surface_altitude_walk_m_sqrt_s = 1e-3;
  double heading_bias_sigma_rad = 0.0175;
  double heading_bias_time_constant_s = 1800.0;
  double heading_deviation_sigma_rad = 0.035;
  double usbl_bias_sigma_m = 2.0;
  double usbl_misalignment_sigma_rad = 0.0087;
  double beacon_place_sigma_m = 1.0;  ///< surveyed from a boat with GPS
  double gps_bias_sigma_m = 1.5;
  double gps_bias_time_constant_s = 300.0;
  double gps_latency_sigma_s = 0.05;
  double gps_lever_sigma_m = 0.2;
  double log_scale_sigma = 0.02;
  double airspeed_bias_sigma_m_s = 1.5;
  double airspeed_scale_sigma = 0.1;
  double flow_angle_sigma_rad = 0.05;
  double flow_angle_time_constant_s = 5.0;
  double baro_bias_sigma_m = 100.0;
  double baro_bias_walk_m_sqrt_s = 0.05;
  double mount_angle_sigma_rad = 0.035;
  double mount_lever_sigma_m = 1.0;
  double model_scale_sigma = 0.2;
  double model_bias_sigma_m_s = 0.01;
  double model_bias_time_constant_s = 120.0;
  double vertical_deflection_sigma_rad = 34e-6;  ///< 7 arcsec: rms of a global gravity model (EGM2008)
  double mounting_sigma_rad = 0.0;               ///< the configured mounting is where the axes are
};

enum class GateMode : std::uint8_t { whole = 0, per_component = 1 };
enum class RobustKind : std::uint8_t { none = 0, huber = 1, student_t = 2 };

/// One instrument that may aid, keyed by the sensor name in its samples. A sensor that is not listed is never
/// used: its samples get the verdict source_disabled.
struct SensorConfig {
  std::string sensor;
  SourceKind kind = SourceKind::gps;
  bool enabled = true;
  std::array<double, 3> lever_B_m{0, 0, 0};
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};
  double latency_s = 0.0;
  /// Noise of each component in the SI unit of the kind: three keys in files, one for each unit.
  std::array<double, 3> sigma{1.0, 1.0, 1.0};
  std::array<double, 3> velocity_sigma_m_s{0.1, 0.1, 0.1};
  double proportional_sigma = 0.0;
  double max_noise_factor = 30.0;
  bool use_sample_sigma = true;
  bool use_position = true;
  bool use_velocity = true;
  std::uint8_t min_fix = 4;
  bool refuse_spoofed = true;
  double gate_probability = 0.999;
  GateMode gate_mode = GateMode::whole;
  RobustKind robust = RobustKind::none;
  double robust_parameter = 5.0;
  double robust_reject_ratio = 25.0;
  double reacquire_s = 10.0;
  double dispute_s = 600.0;
  double reacquire_step_m = 50.0;
  double frozen_change = 0.0;
  bool two_antenna = false;
  double angle_sigma_rad = 0.0087;
  bool transceiver_known = false;
  double transceiver_latitude_rad = 0.0;
  double transceiver_longitude_rad = 0.0;
  double transceiver_depth_m = 0.0;
  double sideslip_sigma_rad = 0.0;
  double attack_sigma_rad = 0.0;
  double gust_time_s = 0.0;
  double baro_sigma_m = 0.0;
  bool use_beams = false;
  double beam_angle_rad = 0.5235987755982988;
  std::array<double, 4> beam_azimuth_rad{-1.5707963267948966, 1.5707963267948966, 0.0, 3.141592653589793};
  double scale_m_s_per_rpm = 0.0;
  double min_depth_m = 0.0;
  double slip_time_s = 10.0;
};

/// A sensor with the defaults of its kind, which stand beside its aiding model (aiding/).
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
  double averaging_s = 8.0;
  double rate_spread_rad_s = 0.05;
  double force_spread_m_s2 = 0.5;
  double max_speed_m_s = 0.7;
  double rest_velocity_sigma_m_s = 0.3;
  double tilt_sigma_floor_rad = 2e-3;
  double compass_sigma_rad = 0.026;
  double gyrocompass_limit_rad = 0.09;
  double in_motion_speed_m_s = 0.0;
  double in_motion_heading_sigma_rad = 0.17;
  double in_motion_tilt_sigma_rad = 0.09;
  double in_motion_averaging_s = 2.0;
  double aligned_tilt_sigma_rad = 5e-3;
  double aligned_heading_sigma_rad = 0.044;
  double aligned_hold_s = 1.0;
  double timeout_s = 600.0;
  bool position_given = false;
  double given_latitude_rad = 0.0;
  double given_longitude_rad = 0.0;
  double given_altitude_m = 0.0;
  double position_sigma_m = 3.0;
};

/// A vehicle on wheels: no velocity sideways and upwards at one point of it.
struct NonHolonomicConfig {
  bool enabled = false;
  double rate_hz = 10.0;
  std::array<double, 3> lever_B_m{0, 0, 0};
  std::array<double, 3> mounting_rpy_rad{0, 0, 0};
  double lateral_sigma_m_s = 0.1;
  double vertical_sigma_m_s = 0.1;
  double slip_time_s = 0.0;
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
  std::string coefficients_file;
  hydro::HydroCoefficients coefficients;
  std::array<double, 3> origin_B_m{0, 0, 0};
  std::array<double, 2> sigma_m_s{0.02, 0.02};
  double correlation_time_s = 3.0;
  double fins_timeout_s = 2.0;
  double min_depth_m = 1.0;
  double settle_s = 30.0;
  double memory_s = 60.0;
  double trial_s = 30.0;
  double doubt_limit = 9.0;
};

/// Whose attitude, rate and force are published.
enum class OutputAxes : std::uint8_t {
  body = 0,    ///< B, as the configuration mounts the inertial unit in it
  wheels = 1,  ///< those of the non-holonomic constraint with the mount angles found: where the vehicle goes;
               ///< without the constraint nothing finds them, and it is B
};

/// A limit that the forecast watches.
struct ForecastLimitConfig {
  std::string name;
  double limit = 100.0;
};

/// Where the altimeter sits, and how long what it heard holds. Its axis is the body's down axis.
struct AltimeterConfig {
  std::string sensor;
  std::array<double, 3> lever_B_m{0.0, 0.0, 0.0};
  double latency_s = 0.0;
  double fresh_s = 2.0;
};

struct EngineConfig {
  std::string vehicle = "auv";
  std::string sensor = "fusion";           ///< header.sensor of what the engine says
  std::string configuration = "standard";  ///< name that goes into NavDetail
  StateGroups groups;                      ///< the default is that of "standard", see EngineConfig()
  LeftOut left_out = LeftOut::considered;
  ImuConfig imu;
  StateModelConfig states;
  std::vector<SensorConfig> sensors;
  AlignmentConfig alignment;
  DropConfig air_drop;  ///< for StartMode::air_drop; what start_from() and the sensors say goes before it
  ConstraintsConfig constraints;
  VehicleModelConfig vehicle_model;
  double horizon_s = 5.0;
  double snapshot_interval_s = 0.2;
  std::uint32_t replay_steps_per_sample = 256;
  double late_fix_memory_s = 900.0;
  double future_tolerance_s = 0.5;
  std::uint32_t measurement_capacity = 2048;
  bool magnetic_variation_known = false;
  double magnetic_variation_rad = 0.0;
  double gps_timeout_s = 3.0;
  double usbl_timeout_s = 15.0;
  double velocity_timeout_s = 3.0;
  double zero_velocity_sigma_m_s = 0.02;
  AltimeterConfig altimeter;
  std::array<double, 3> output_lever_B_m{0, 0, 0};
  OutputAxes output_axes = OutputAxes::body;
  double forecast_span_s = 600.0;
  std::vector<ForecastLimitConfig> forecast_limits;

  EngineConfig();
  /// How well roll and pitch have to be known to be aligned: as configured, or as well as these
  /// accelerometers can show at all, twice what their scale and misalignment make of gravity.
  [[nodiscard]] double aligned_tilt_sigma_rad() const;
  /// What is beyond the horizon is remembered: for fixes, where there may be some.
  [[nodiscard]] bool remembers() const;
  /// The groups that are considered.
  [[nodiscard]] StateGroups considered() const;
  /// The first value that is not as described, or that does not go with another. Its key is that of a file.
  [[nodiscard]] std::optional<Complaint> complaint() const;
  /// Its text; empty when there is none.
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

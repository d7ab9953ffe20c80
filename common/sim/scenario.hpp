#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "base/unknown.hpp"
#include "sim/environment.hpp"
#include "sim/sensors/suite.hpp"

namespace fathom::sim {

/// One standard deviation by which the true start differs from the configured one, drawn once a run: what is
/// handed over to navigation is known as well as this and no better.
struct StartSpread {
  std::array<double, 3> position_N_m{0.0, 0.0, 0.0};
  std::array<double, 3> velocity_N_m_s{0.0, 0.0, 0.0};
  std::array<double, 3> attitude_rad{0.0, 0.0, 0.0};  ///< about north, east, down
};

/// Where and how the body origin starts, t = 0.
struct StartConfig {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double depth_m = 0.0;    ///< below the mean surface; negative above
  double speed_m_s = 0.0;  ///< along the body's x axis, through the medium
  std::array<double, 3> rpy_rad{0.0, 0.0, 0.0};
  StartSpread spread;
};

/// An order to the autopilot from `at_s` on. Unknown values keep what the step before said.
struct MissionStep {
  double at_s = 0.0;
  double speed_m_s = kUnknown;  ///< through the medium
  double heading_rad = kUnknown;
  double depth_m = kUnknown;         ///< below the mean surface; negative: height above it
  double bank_rad = kUnknown;        ///< aircraft: 0 holds the heading, else a turn at this bank
  double dutch_roll_rad = kUnknown;  ///< aircraft: amplitude of an oscillation in roll and sideslip
};

/// Torpedo-shaped vehicle driven by a propulsor and fins. Time and length constants of its responses.
struct AuvConfig {
  double speed_per_rpm = 0.002;  ///< steady speed through the water per rpm, m/s
  double surge_drag_1_m = 0.12;  ///< deceleration = this u^2
  double sway_length_m = 3.0;    ///< distance travelled in one time constant of the side-slip
  double turn_slip_m = 1.0;      ///< side-slip velocity per turn rate
  double heave_length_m = 3.0;
  double yaw_length_m = 4.0;  ///< distance travelled in one time constant of the turn rate
  double pitch_length_m = 3.0;
  double rudder_1_m = 0.25;  ///< steady turn rate per speed and rudder angle
  double stern_1_m = 0.25;
  double righting_1_s2 = 0.2;  ///< pitch stiffness of the low centre of gravity
  double roll_frequency_rad_s = 1.6;
  double roll_damping = 0.25;       ///< ratio
  double roll_per_turn_s_m = 0.02;  ///< heel per side acceleration
  double buoyancy_ratio = 1.003;    ///< displacement over weight
  double hull_diameter_m = 0.3;
  double fin_limit_rad = 0.4363;  ///< 25 degrees
  double fin_tau_s = 0.25;
  double propulsor_tau_s = 0.8;
  double maximum_pitch_rad = 0.3491;  ///< 20 degrees
  double maximum_turn_rate_rad_s = 0.12;
};

/// What a real hull does beyond the equations of Gertler and Hagen that estimators are given.
struct RemusBeyondModel {
  double linear_damping_share =
      0.0;                        ///< of the quadratic drag ahead and lift across at cruise, added linearly
  double cross_flow_share = 0.0;  ///< of the cross-flow drag: coupling by the speed of the whole flow
  double thrust_lag_s = 0.0;      ///< of the thrust behind the shaft speed
  double trim_moment_sigma_N_m = 0.0;  ///< constant pitch and yaw moment of a hull out of trim, drawn once
};

/// REMUS 100 (Prestero 2001) in six degrees of freedom. The hull's coefficients belong to the vehicle; its
/// actuators and what the autopilot may ask for are free.
struct RemusConfig {
  /// Each hydrodynamic coefficient times a factor of its own, uniform within 1 +- this, drawn once a run.
  double coefficient_share = 0.0;
  RemusBeyondModel beyond;
  double fin_limit_rad = 0.2374;  ///< 13.6 degrees
  double fin_tau_s = 0.1;
  double propulsor_tau_s = 0.5;
  double maximum_pitch_rad = 0.3;
  double maximum_turn_rate_rad_s = 0.1;
  double hull_diameter_m = 0.19;
};

/// Vehicle released from an aircraft: parachute, water entry, dive, run at set depth.
struct AirDropConfig {
  /// One standard deviation of the factor of each coefficient of the hull, drawn once a run. Mass and
  /// buoyancy are weighed ashore and stay.
  double coefficient_sigma = 0.0;
  double parachute_at_s = 0.8;
  double terminal_speed_m_s = 44.0;  ///< under the parachute
  double mass_kg = 240.0;
  double buoyancy_kg = 205.0;
  double added_surge_kg = 6.0;
  double added_sway_kg = 200.0;
  double inertia_roll_kg_m2 = 3.2;
  double inertia_pitch_kg_m2 = 205.0;  ///< with added mass
  double drag_coefficient = 0.11;
  double frontal_area_m2 = 0.0824;
  double tail_lift_kg_m = 98.4;  ///< force per product of speed and cross flow at the tail
  double body_lift_kg_m = 42.2;
  double fin_lift_kg_m = 67.6;
  double munk_kg = 126.0;
  double tail_x_m = -1.15;
  double length_m = 2.8;
  double speed_per_rpm = 0.0068;
  double dive_pitch_rad = -0.5236;    ///< -30 degrees
  double limited_pitch_rad = 0.0820;  ///< 4.7 degrees, within limited_range_m of the set depth
  double limited_range_m = 12.0;
  double pitch_slew_rad_s = 0.3;   ///< of the pitch ordered, from water entry on ...
  double flare_slew_rad_s = 0.7;   ///< ... and from the flare on
  double flare_s = 1.05;           ///< the flare starts at this depth error per sink rate
  double propulsor_delay_s = 0.3;  ///< after water entry
};

struct AircraftConfig {
  double roll_frequency_rad_s = 1.5;
  double pitch_frequency_rad_s = 1.0;
  double rate_tau_s = 0.25;
  double speed_tau_s = 4.0;
  double slip_tau_s = 0.8;
  double angle_of_attack_rad = 0.05;  ///< in level flight
  double maximum_climb_rad = 0.12;
  double maximum_bank_rad = 0.5236;
  double dutch_roll_period_s = 4.0;
};

/// A carriage at the end of an arm that turns about a fixed axle; it heads along the circle.
struct RotatingArmConfig {
  double radius_m = 8.0;
  double acceleration_m_s2 = 0.25;
};

struct VehicleConfig {
  enum class Kind { auv, air_drop, aircraft, rotating_arm, remus };
  Kind kind = Kind::auv;
  AuvConfig auv;
  AirDropConfig air_drop;
  AircraftConfig aircraft;
  RotatingArmConfig rotating_arm;
  RemusConfig remus;
};

/// What a run of the scenario has to reach. Unknown: not asked for.
struct ScenarioLimits {
  double horizontal_rms_m = 5.0;
  double horizontal_max_m = kUnknown;
  double roll_pitch_rms_rad = kUnknown;
  double yaw_rms_rad = kUnknown;
  double aligned_within_s = kUnknown;  ///< of the start
  double score_from_s = 0.0;           ///< earlier navigation is not scored
  int gps_outages_at_least = 0;        ///< in a run of the default duration
  /// Names of the alarms that belong to the scenario; one that ends in '*' stands for all that begin so.
  std::vector<std::string> expected_alarms;
};

struct Scenario {
  std::string name;
  std::string description;
  double duration_s = 90.0;  ///< of a run where nothing else is said
  EnvironmentConfig environment;
  StartConfig start;
  VehicleConfig vehicle;
  std::vector<MissionStep> mission;
  SensorSuite sensors;
  std::vector<std::string> bridges;  ///< e.g. "imu", "gps": the bridges that a run needs
  /// Overrides of the services' configurations, as after --set: service, key, value.
  std::map<std::string, std::map<std::string, std::string>> services;
  ScenarioLimits limits;
};

}  // namespace fathom::sim

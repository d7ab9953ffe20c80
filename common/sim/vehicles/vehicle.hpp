#pragma once

#include <memory>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "base/units.hpp"
#include "sim/random.hpp"
#include "sim/scenario.hpp"

namespace fathom::sim {

/// What a vehicle's dynamics see. The medium is water below the surface and air above.
struct BodyState {
  double t_s = 0.0;
  double depth_m = 0.0;                               ///< of the body origin below the mean surface
  Eigen::Vector3d V_B_m_s = Eigen::Vector3d::Zero();  ///< through the medium, body axes
  Eigen::Vector3d omega_NB_B_rad_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_NB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d actuator = Eigen::Vector3d::Zero();  ///< propulsor rpm, rudder rad, stern planes rad
  /// What the autopilot takes for the attitude: the truth, unless a study closes the loop over a navigator.
  Eigen::Quaterniond q_steered_NB = Eigen::Quaterniond::Identity();
};

struct BodyRates {
  Eigen::Vector3d V_dot_B_m_s2 = Eigen::Vector3d::Zero();  ///< of the components along the turning body axes
  Eigen::Vector3d omega_dot_B_rad_s2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d actuator_dot = Eigen::Vector3d::Zero();
};

/// The order in force: a mission step without unknowns.
struct Order {
  double speed_m_s = 0.0;
  double heading_rad = 0.0;
  double depth_m = 0.0;
  double bank_rad = 0.0;
  double dutch_roll_rad = 0.0;
};

/// Rigid body and autopilot. The autopilot sees the true state: navigation errors do not feed back into the
/// motion, so that a run's truth does not depend on the estimator under test. The air drop alone may be
/// steered by a navigated attitude (q_steered_NB), because there the feedback is what the alignment has to
/// live with.
class Vehicle {
 public:
  virtual ~Vehicle() = default;
  /// Autopilot, once per inertial sample; `dt_s` until the next call.
  virtual void control(const BodyState& state, const Order& order, double dt_s) = 0;
  /// Equations of motion between two calls of control(): smooth in time and state, no side effects.
  [[nodiscard]] virtual BodyRates dynamics(const BodyState& state) const = 0;
};

/// Standard gravity of the vehicle dynamics. The sensed gravity is the WGS-84 one; this only shapes the
/// motion.
inline constexpr double kModelGravity_m_s2 = kStandardGravity_m_s2;

[[nodiscard]] std::unique_ptr<Vehicle> make_auv(const AuvConfig& config, const EnvironmentConfig& environment,
                                                std::uint64_t seed);
[[nodiscard]] std::unique_ptr<Vehicle> make_air_drop(const AirDropConfig& config,
                                                     const EnvironmentConfig& environment,
                                                     std::uint64_t seed);
[[nodiscard]] std::unique_ptr<Vehicle> make_remus(const RemusConfig& config,
                                                  const EnvironmentConfig& environment, std::uint64_t seed);
[[nodiscard]] std::unique_ptr<Vehicle> make_aircraft(const AircraftConfig& config,
                                                     const EnvironmentConfig& environment,
                                                     std::uint64_t seed);
[[nodiscard]] std::unique_ptr<Vehicle> make_rotating_arm(const RotatingArmConfig& config);
[[nodiscard]] std::unique_ptr<Vehicle> make_vehicle(const Scenario& scenario, std::uint64_t seed);

/// Roll, pitch, yaw (Z-Y-X) of a rotation of B into N; yaw in (-pi, pi].
[[nodiscard]] Eigen::Vector3d rpy_of(const Eigen::Quaterniond& q_NB);
[[nodiscard]] Eigen::Quaterniond q_of_rpy(double roll_rad, double pitch_rad, double yaw_rad);
/// 0 below 0, 1 above 1, once differentiable in between.
[[nodiscard]] double smooth_step(double x);
[[nodiscard]] double smooth_step_slope(double x);

}  // namespace fathom::sim

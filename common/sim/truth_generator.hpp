#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "sim/scenario.hpp"

namespace fathom::sim {

/// The true motion at one instant. The body origin is where the inertial sensors sit.
struct TruthPoint {
  double t_s = 0.0;  ///< since the start of the run
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;  ///< above the ellipsoid
  Eigen::Vector3d v_N_m_s = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_NB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d omega_NB_B_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_IB_B_rad_s = Eigen::Vector3d::Zero();  ///< what perfect gyros sense now
  Eigen::Vector3d f_B_m_s2 = Eigen::Vector3d::Zero();          ///< what perfect accelerometers sense now
  Eigen::Vector3d V_B_m_s = Eigen::Vector3d::Zero();           ///< through water or air, body axes
  double depth_m = 0.0;                                        ///< of the body origin below the mean surface
  double water_depth_m = 0.0;                                  ///< surface to bottom, here
  double rpm = 0.0;
  double rudder_rad = 0.0;
  double stern_rad = 0.0;
};

/// What perfect inertial sensors integrate over one sample interval, in the body axes of each instant.
struct ImuTruth {
  double dt_s = 0.0;
  Eigen::Vector3d delta_angle_B_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d delta_velocity_B_m_s = Eigen::Vector3d::Zero();
};

/// Moves the vehicle of a scenario. One set of differential equations yields position, velocity and attitude
/// on the rotating ellipsoid and the integrals of angular rate and specific force, so the inertial truth
/// belongs to the trajectory to the accuracy of the integration (RK4, steps of at most 5 ms):
///
///   v_N = C_NB V_B + c_N
///
///   f_B = V_dot_B + omega_NB x V_B + C_BN (c_dot_N + (2 omega_IE + omega_EN) x v_N - g_N)
///
///   omega_IB_B = omega_NB_B + C_BN (omega_IE + omega_EN)
///
/// with V_B the velocity through the medium and c_N the medium's own.
class TruthGenerator {
 public:
  TruthGenerator(const Scenario& scenario, std::uint64_t seed);
  ~TruthGenerator();
  TruthGenerator(TruthGenerator&&) noexcept;
  TruthGenerator& operator=(TruthGenerator&&) noexcept;

  [[nodiscard]] const TruthPoint& point() const;
  /// Advances to `t_s` seconds since the start, in one sample interval. Precondition: t_s > point().t_s.
  ImuTruth advance_to(double t_s);
  /// From now on the autopilot takes this for the attitude; see BodyState::q_steered_NB.
  void steer_by(const Eigen::Quaterniond& q_NB);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The motion between two points at most some tens of milliseconds apart: cubic in position, attitude by the
/// mean turn rate. Precondition: a.t_s <= t_s <= b.t_s.
[[nodiscard]] TruthPoint interpolate(const TruthPoint& a, const TruthPoint& b, double t_s);

/// The point at a lever arm from the body origin, fixed to the body: position and velocity of that point, all
/// else as given.
[[nodiscard]] TruthPoint at_lever(const TruthPoint& point, const Eigen::Vector3d& lever_B_m);

}  // namespace fathom::sim

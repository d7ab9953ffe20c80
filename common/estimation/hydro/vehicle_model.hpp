#pragma once

#include "estimation/hydro/coefficients.hpp"

namespace fathom::estimation::hydro {

/// What drives the vehicle.
struct Controls {
  double rpm = 0.0;  ///< of the propulsor's shaft, negative astern
  double rudder_rad = 0.0;
  double stern_rad = 0.0;
};

/// Six-degree-of-freedom motion of a submerged vehicle through the water (HYD-1..3). The state nu is u, v, w
/// (m/s, through the water) and p, q, r (rad/s), along and about the body axes; gamma the direction of
/// gravity in body axes, (0, 0, 1) when level. The mass matrix is inverted once.
class VehicleModel {
 public:
  /// Precondition: coefficients.validate() is empty.
  explicit VehicleModel(const HydroCoefficients& coefficients);

  [[nodiscard]] const HydroCoefficients& coefficients() const { return c_; }
  [[nodiscard]] const Matrix6& mass() const { return mass_; }
  [[nodiscard]] const Matrix6& mass_inverse() const { return inverse_; }

  /// Force (N) that acts along the body axes: what turning axes make of the rigid body's momentum, and the
  /// water, gravity, fins and propulsor (HYD-2).
  [[nodiscard]] Eigen::Vector3d force(const Eigen::Vector3d& V_B_m_s, const Eigen::Vector3d& omega_B_rad_s,
                                      const Eigen::Vector3d& gamma_B, const Controls& controls) const;
  /// Moment (N m) likewise.
  [[nodiscard]] Eigen::Vector3d moment(const Eigen::Vector3d& V_B_m_s, const Eigen::Vector3d& omega_B_rad_s,
                                       const Eigen::Vector3d& gamma_B, const Controls& controls) const;
  /// Both.
  [[nodiscard]] Vector6 load(const Vector6& nu, const Eigen::Vector3d& gamma_B,
                             const Controls& controls) const {
    Vector6 out;
    out << force(nu.head<3>(), nu.tail<3>(), gamma_B, controls),
        moment(nu.head<3>(), nu.tail<3>(), gamma_B, controls);
    return out;
  }
  /// d(nu)/dt.
  [[nodiscard]] Vector6 derivative(const Vector6& nu, const Eigen::Vector3d& gamma_B,
                                   const Controls& controls) const {
    return inverse_ * load(nu, gamma_B, controls);
  }
  /// One Runge-Kutta step with gamma and controls held.
  [[nodiscard]] Vector6 step(const Vector6& nu, const Eigen::Vector3d& gamma_B, const Controls& controls,
                             double dt_s) const;

 private:
  /// Thrust and torque relative to those at propulsor_rpm.
  [[nodiscard]] double thrust(const Controls& controls) const;

  HydroCoefficients c_;
  Matrix6 mass_;
  Matrix6 inverse_;
};

}  // namespace fathom::estimation::hydro

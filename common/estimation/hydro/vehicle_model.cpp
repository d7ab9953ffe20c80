#include "estimation/hydro/vehicle_model.hpp"

#include <cmath>

#include <Eigen/LU>

#include "estimation/hydro/runge_kutta.hpp"

namespace fathom::estimation::hydro {

using Eigen::Vector3d;

VehicleModel::VehicleModel(const HydroCoefficients& coefficients)
    : c_(coefficients), mass_(mass_matrix(coefficients)), inverse_(mass_.inverse()) {}

double VehicleModel::thrust(const Controls& controls) const {
  return controls.rpm * std::abs(controls.rpm) / (c_.propulsor_rpm * c_.propulsor_rpm);
}

Vector3d VehicleModel::force(const Vector3d& V_B_m_s, const Vector3d& omega_B_rad_s, const Vector3d& gamma_B,
                             const Controls& controls) const {
  // (HYD-2)
  const double u = V_B_m_s.x();
  const double v = V_B_m_s.y();
  const double w = V_B_m_s.z();
  const double p = omega_B_rad_s.x();
  const double q = omega_B_rad_s.y();
  const double r = omega_B_rad_s.z();
  const double m = c_.mass();
  const double thrust_share = thrust(controls);
  const double heave_excess = c_.weight - c_.buoyancy;
  Vector3d out;
  out[0] = m * (v * r - w * q + c_.x_G * (q * q + r * r) - c_.y_G * p * q - c_.z_G * p * r) +
           heave_excess * gamma_B.x() + c_.X_uu * u * std::abs(u) + c_.X_wq * w * q + c_.X_qq * q * q +
           c_.X_vr * v * r + c_.X_rr * r * r + c_.X_prop * thrust_share;
  out[1] = m * (w * p - u * r + c_.y_G * (r * r + p * p) - c_.z_G * q * r - c_.x_G * p * q) +
           heave_excess * gamma_B.y() + c_.Y_vv * v * std::abs(v) + c_.Y_rr * r * std::abs(r) +
           c_.Y_uv * u * v + c_.Y_ur * u * r + c_.Y_wp * w * p + c_.Y_pq * p * q +
           c_.Y_uudr * u * u * controls.rudder_rad;
  out[2] = m * (u * q - v * p + c_.z_G * (p * p + q * q) - c_.x_G * r * p - c_.y_G * r * q) +
           heave_excess * gamma_B.z() + c_.Z_ww * w * std::abs(w) + c_.Z_qq * q * std::abs(q) +
           c_.Z_uw * u * w + c_.Z_uq * u * q + c_.Z_vp * v * p + c_.Z_rp * r * p +
           c_.Z_uuds * u * u * controls.stern_rad;
  return out;
}

Vector3d VehicleModel::moment(const Vector3d& V_B_m_s, const Vector3d& omega_B_rad_s, const Vector3d& gamma_B,
                              const Controls& controls) const {
  // (HYD-2)
  const double u = V_B_m_s.x();
  const double v = V_B_m_s.y();
  const double w = V_B_m_s.z();
  const double p = omega_B_rad_s.x();
  const double q = omega_B_rad_s.y();
  const double r = omega_B_rad_s.z();
  const double m = c_.mass();
  const Vector3d arm(c_.x_G * c_.weight - c_.x_B * c_.buoyancy, c_.y_G * c_.weight - c_.y_B * c_.buoyancy,
                     c_.z_G * c_.weight - c_.z_B * c_.buoyancy);
  Vector3d out;
  out[0] = (c_.I_yy - c_.I_zz) * q * r + m * (c_.y_G * (u * q - v * p) - c_.z_G * (w * p - u * r)) +
           arm.y() * gamma_B.z() - arm.z() * gamma_B.y() + c_.K_pp * p * std::abs(p) +
           c_.K_prop * thrust(controls);
  out[1] = (c_.I_zz - c_.I_xx) * r * p + m * (c_.z_G * (v * r - w * q) - c_.x_G * (u * q - v * p)) +
           arm.z() * gamma_B.x() - arm.x() * gamma_B.z() + c_.M_ww * w * std::abs(w) +
           c_.M_qq * q * std::abs(q) + c_.M_uq * u * q + c_.M_vp * v * p + c_.M_rp * r * p + c_.M_uw * u * w +
           c_.M_uuds * u * u * controls.stern_rad;
  out[2] = (c_.I_xx - c_.I_yy) * p * q + m * (c_.x_G * (w * p - u * r) - c_.y_G * (v * r - w * q)) +
           arm.x() * gamma_B.y() - arm.y() * gamma_B.x() + c_.N_vv * v * std::abs(v) +
           c_.N_rr * r * std::abs(r) + c_.N_ur * u * r + c_.N_wp * w * p + c_.N_pq * p * q + c_.N_uv * u * v +
           c_.N_uudr * u * u * controls.rudder_rad;
  return out;
}

Vector6 VehicleModel::step(const Vector6& nu, const Vector3d& gamma_B, const Controls& controls,
                           double dt_s) const {
  return runge_kutta(nu, dt_s, [&](const Vector6& at) { return derivative(at, gamma_B, controls); });
}

}  // namespace fathom::estimation::hydro

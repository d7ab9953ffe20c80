#include "study/baselines/embedded_dynamics.hpp"

#include <cmath>

namespace fathom::study::hydro {

using Eigen::Vector3d;

EmbeddedDynamics::EmbeddedDynamics(const VehicleModel& model, const NavigatorView& navigator,
                                   const Controls& controls, const Sphere& sphere)
    : model_(model), C_BN_(navigator.C_NB.transpose()), controls_(controls) {
  // (HYD-UKF-1): no error of altitude, its rate or v_D; position in metres grows with the velocity alone.
  const InsErrorMatrices m = ins_error_matrices(navigator.latitude_rad, navigator.altitude_m,
                                                navigator.v_N_m_s, navigator.f_N_m_s2, sphere);
  const Eigen::Vector2d to_rad(1.0 / sphere.radius_m,
                               1.0 / (sphere.radius_m * std::cos(navigator.latitude_rad)));
  errors_.setZero();
  errors_.block<2, 2>(0, 2).setIdentity();
  errors_.block<2, 2>(2, 0) = m.V_rho.topLeftCorner<2, 2>() * to_rad.asDiagonal();
  errors_.block<2, 2>(2, 2) = m.V_v.topLeftCorner<2, 2>();
  errors_.block<2, 3>(2, 4) = m.V_phi.topRows<2>();
  errors_.block<3, 2>(4, 0) = m.W_rho.leftCols<2>() * to_rad.asDiagonal();
  errors_.block<3, 2>(4, 2) = m.W_v.leftCols<2>();
  errors_.block<3, 3>(4, 4) = m.W_phi;
}

EmbeddedDynamics::State EmbeddedDynamics::derivative(const State& x) const {
  const Vector3d phi = x.segment<3>(kPhi);
  // gamma = C' (I - [phi x]) e3
  const Vector3d gamma_B = C_BN_ * (Vector3d::UnitZ() - Vector3d(phi.y(), -phi.x(), 0.0));
  State dot;
  dot.head<6>() = model_.derivative(x.head<6>(), gamma_B, controls_);
  dot.tail<7>() = errors_ * x.tail<7>();
  return dot;
}

}  // namespace fathom::study::hydro

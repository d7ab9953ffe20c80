#include "analytic_vehicle.hpp"

namespace fathom::test {
namespace {

template <class F>
auto derivative(F f, double t) {
  constexpr double h = 2e-3;
  return ((8.0 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12.0 * h)).eval();
}

}  // namespace

Eigen::Vector3d AnalyticVehicle::rate_nb_B_rad_s() const {
  return rate_ib_B_rad_s() - C_NB().transpose() * (geo::earth_rate_N(position_.latitude_rad) +
                                                   geo::transport_rate_N(position_, v_N_m_s()));
}

void AnalyticVehicle::step(Eigen::Vector3d& dtheta_rad, Eigen::Vector3d& dv_m_s) {
  const double offset = 0.5 * std::sqrt(0.6);
  const double nodes[3] = {0.5 - offset, 0.5, 0.5 + offset};
  const double weights[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  dtheta_rad.setZero();
  dv_m_s.setZero();
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double t = time_s_ + nodes[i] * step_s_;
    const geo::Geodetic here = geo::moved_by(position_, nodes[i] * step_s_ * velocity(time_s_));
    dtheta_rad += weights[i] * step_s_ * rate(t, here);
    dv_m_s += weights[i] * step_s_ * force(t, here);
    moved += weights[i] * step_s_ * velocity(t);
  }
  position_ = geo::moved_by(position_, moved);
  ++steps_;
  time_s_ = static_cast<double>(steps_) * step_s_;
}

Eigen::Matrix3d AnalyticVehicle::attitude(double t) const {
  return geo::to_matrix(geo::from_rpy(motion_.rpy_rad(t)));
}

Eigen::Vector3d AnalyticVehicle::velocity(double t) const {
  return attitude(t) * Eigen::Vector3d(motion_.speed_m_s(t), 0.0, 0.0);
}

Eigen::Vector3d AnalyticVehicle::rate(double t, const geo::Geodetic& at) const {
  const Eigen::Matrix3d c = attitude(t);
  const Eigen::Matrix3d c_dot = derivative([this](double s) { return attitude(s); }, t);
  const Eigen::Matrix3d turning = c.transpose() * c_dot;
  const Eigen::Vector3d rate_nb(0.5 * (turning(2, 1) - turning(1, 2)), 0.5 * (turning(0, 2) - turning(2, 0)),
                                0.5 * (turning(1, 0) - turning(0, 1)));
  return rate_nb +
         c.transpose() * (geo::earth_rate_N(at.latitude_rad) + geo::transport_rate_N(at, velocity(t)));
}

Eigen::Vector3d AnalyticVehicle::force(double t, const geo::Geodetic& at) const {
  const Eigen::Vector3d v = velocity(t);
  const Eigen::Vector3d v_dot = derivative([this](double s) { return velocity(s); }, t);
  const Eigen::Vector3d turning = 2.0 * geo::earth_rate_N(at.latitude_rad) + geo::transport_rate_N(at, v);
  const Eigen::Vector3d gravity = geo::gravity_N(at.latitude_rad, at.altitude_m);
  return attitude(t).transpose() * (v_dot + geo::cross(turning, v) - gravity);
}

}  // namespace fathom::test

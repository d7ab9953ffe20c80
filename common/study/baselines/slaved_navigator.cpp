#include "study/baselines/slaved_navigator.hpp"

namespace fathom::study::hydro {
namespace {

using Eigen::Vector3d;

// Natural frequency 0.5 rad/s, damping 0.7: faster than anything tilt does, slower than the gauge's noise.
constexpr double kAltitudeGain_1_s = 0.7;
constexpr double kVelocityGain_1_s2 = 0.25;

}  // namespace

void SlavedNavigator::start(const NavSolution& nav, double surface_altitude_m) {
  *this = SlavedNavigator{};
  nav_ = nav;
  surface_altitude_m_ = surface_altitude_m;
}

void SlavedNavigator::advance(const Vector3d& dtheta_rad, const Vector3d& dv_m_s, double dt_s) {
  estimation::Increments in;
  in.dt_s = dt_s;
  in.dtheta_rad = dtheta_rad - dt_s * gyro_bias_B_;
  in.dv_m_s = dv_m_s;
  in.dtheta_before_rad = has_before_ ? dtheta_before_ : in.dtheta_rad;
  in.dv_before_m_s = has_before_ ? dv_before_ : in.dv_m_s;
  dtheta_before_ = in.dtheta_rad;
  dv_before_ = in.dv_m_s;
  has_before_ = true;
  const Eigen::Matrix3d c = geo::to_matrix(nav_.q_NB);
  rate_nb_B_ = in.dtheta_rad / dt_s - c.transpose() * (geo::earth_rate_N(nav_.position.latitude_rad) +
                                                       geo::transport_rate_N(nav_.position, nav_.v_N_m_s));
  force_sum_N_ += c * dv_m_s;
  force_s_ += dt_s;
  nav_ = mechanise(nav_, estimation::correct(in));
}

void SlavedNavigator::slave(double depth_m, double dt_s) {
  const double high = nav_.position.altitude_m - (surface_altitude_m_ - depth_m);
  nav_.position.altitude_m -= kAltitudeGain_1_s * high * dt_s;
  nav_.v_N_m_s.z() += kVelocityGain_1_s2 * high * dt_s;
}

NavigatorView SlavedNavigator::view() {
  NavigatorView out;
  out.C_NB = geo::to_matrix(nav_.q_NB);
  if (force_s_ > 0.0) out.f_N_m_s2 = force_sum_N_ / force_s_;
  out.v_N_m_s = nav_.v_N_m_s;
  out.latitude_rad = nav_.position.latitude_rad;
  out.altitude_m = nav_.position.altitude_m;
  force_sum_N_.setZero();
  force_s_ = 0.0;
  return out;
}

void SlavedNavigator::correct(const Eigen::Matrix<double, 7, 1>& error) {
  nav_.position = geo::moved_by(nav_.position, Vector3d(-error[0], -error[1], 0.0));
  nav_.v_N_m_s -= Vector3d(error[2], error[3], 0.0);
  nav_.q_NB = geo::normalized(geo::exp(Vector3d(error.tail<3>())) * nav_.q_NB);
}

}  // namespace fathom::study::hydro

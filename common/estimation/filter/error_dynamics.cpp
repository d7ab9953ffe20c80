#include "estimation/filter/error_dynamics.hpp"

#include <cmath>

namespace fathom::estimation {

using Eigen::Matrix3d;
using Eigen::Vector3d;

ErrorRates error_rates(const geo::LocalEarth& earth, const Vector3d& v_N_m_s, const Vector3d& force_N_m_s2) {
  // (DYN-1)
  const double per_rm = 1.0 / earth.meridian_m;
  const double per_rn = 1.0 / earth.normal_m;
  const double per_cosine = 1.0 / earth.cosine;
  const double tangent = earth.sine * per_cosine;
  const double vn = v_N_m_s.x();
  const double ve = v_N_m_s.y();
  const double vd = v_N_m_s.z();

  // How the rates of the Earth (W) and of N (E by position, Ev by velocity) change with the error. Only the
  // first and third columns of W and E, and the first two of Ev, are not zero.
  const double w_nn = earth.earth_rate_N.z() * per_rm;
  const double w_dn = -earth.earth_rate_N.x() * per_rm;
  const double e_dn = -ve * per_rm * per_rn * per_cosine * per_cosine;
  const double e_nd = ve * per_rn * per_rn;
  const double e_ed = -vn * per_rm * per_rm;
  const double e_dd = -e_nd * tangent;

  ErrorRates f;
  f.r_r << -vd * per_rm, 0.0, vn * per_rm,                                //
      ve * tangent * per_rm, -(vd + vn * tangent) * per_rn, ve * per_rn,  //
      0.0, 0.0, 0.0;
  f.phi_r << w_nn, 0.0, e_nd,  //
      0.0, 0.0, e_ed,          //
      w_dn + e_dn, 0.0, e_dd;
  f.phi_v << 0.0, per_rn, 0.0,  //
      -per_rm, 0.0, 0.0,        //
      0.0, -tangent * per_rn, 0.0;
  // [v x](2W + E), and gravity that weakens with height.
  const double u_nn = 2.0 * w_nn;
  const double u_dn = 2.0 * w_dn + e_dn;
  const double weaker = 2.0 * earth.gravity_m_s2 * std::sqrt(per_rm * per_rn);
  f.v_r << ve * u_dn, 0.0, ve * e_dd - vd * e_ed,         //
      vd * u_nn - vn * u_dn, 0.0, vd * e_nd - vn * e_dd,  //
      -ve * u_nn, 0.0, vn * e_ed - ve * e_nd + weaker;
  f.rate_in_N_rad_s = earth.earth_rate_N + earth.transport_rate_N(v_N_m_s);
  // [v x]Ev - [(2 rate_ie + rate_en) x]
  const Vector3d t = earth.earth_rate_N + f.rate_in_N_rad_s;
  f.v_v << vd * per_rm, t.z() - ve * tangent * per_rn, -t.y(),  //
      -t.z(), (vd + vn * tangent) * per_rn, t.x(),              //
      t.y() - vn * per_rm, -t.x() - ve * per_rn, 0.0;
  f.force_N_m_s2 = force_N_m_s2;
  return f;
}

Matrix9 error_dynamics(const NavSolution& nav, const Vector3d& force_N_m_s2) {
  const ErrorRates rates = error_rates(geo::LocalEarth(nav.position), nav.v_N_m_s, force_N_m_s2);
  Matrix9 f = Matrix9::Zero();
  f.block<3, 3>(0, 0) = rates.r_r;
  f.block<3, 3>(0, 3).setIdentity();
  f.block<3, 3>(3, 0) = rates.v_r;
  f.block<3, 3>(3, 3) = rates.v_v;
  f.block<3, 3>(3, 6) = geo::skew(force_N_m_s2);
  f.block<3, 3>(6, 0) = rates.phi_r;
  f.block<3, 3>(6, 3) = rates.phi_v;
  f.block<3, 3>(6, 6) = -geo::skew(rates.rate_in_N_rad_s);
  return f;
}

namespace {

/// Effect of the six misalignment states on a measured vector: M = [0 m0 m1; m2 0 m3; m4 m5 0].
Eigen::Matrix<double, 3, 6> misalignment_columns(const Vector3d& v) {
  Eigen::Matrix<double, 3, 6> m = Eigen::Matrix<double, 3, 6>::Zero();
  m(0, 0) = v.y();
  m(0, 1) = v.z();
  m(1, 2) = v.x();
  m(1, 3) = v.z();
  m(2, 4) = v.x();
  m(2, 5) = v.y();
  return m;
}

Vector3d corrected(const StateIndex& index, const std::array<double, kMaxStates>& x, const Vector3d& measured,
                   Group bias, Group scale, Group misalignment) {
  // (IMU-1)
  const auto at = [&](int i) { return x[static_cast<std::size_t>(i)]; };
  const int b = index.of(bias);
  Vector3d v = measured - Vector3d(at(b), at(b + 1), at(b + 2));
  // What is only considered stands at zero.
  const auto found = [&](int state) { return state >= 0 && state < index.estimated(); };
  Vector3d excess = Vector3d::Zero();
  if (const int s = index.of(scale); found(s))
    excess += Vector3d(at(s) * v.x(), at(s + 1) * v.y(), at(s + 2) * v.z());
  if (const int m = index.of(misalignment); found(m))
    excess += Vector3d(at(m) * v.y() + at(m + 1) * v.z(), at(m + 2) * v.x() + at(m + 3) * v.z(),
                       at(m + 4) * v.x() + at(m + 5) * v.y());
  return v - excess;
}

}  // namespace

ImuColumns imu_error_columns(const StateIndex& index, const Matrix3d& C_NB, const Vector3d& rate_B_rad_s,
                             const Vector3d& force_B_m_s2) {
  // (DYN-2): a remaining error d in the force raises dv by C d, in the rate phi by -C d.
  ImuColumns g(kNavStates, index.imu_end() - kNavStates);
  g.setZero();
  const auto column = [&](Group group) { return index.of(group) - kNavStates; };
  g.block<3, 3>(3, column(Group::accel_bias)) = C_NB;
  g.block<3, 3>(6, column(Group::gyro_bias)) = -C_NB;
  if (index.has(Group::accel_scale))
    g.block<3, 3>(3, column(Group::accel_scale)) = C_NB * force_B_m_s2.asDiagonal();
  if (index.has(Group::gyro_scale))
    g.block<3, 3>(6, column(Group::gyro_scale)) = -(C_NB * rate_B_rad_s.asDiagonal());
  if (index.has(Group::accel_misalignment))
    g.block<3, 6>(3, column(Group::accel_misalignment)) = C_NB * misalignment_columns(force_B_m_s2);
  if (index.has(Group::gyro_misalignment))
    g.block<3, 6>(6, column(Group::gyro_misalignment)) = -(C_NB * misalignment_columns(rate_B_rad_s));
  return g;
}

Vector3d corrected_rate(const StateIndex& index, const std::array<double, kMaxStates>& x,
                        const Vector3d& measured_rad_s) {
  return corrected(index, x, measured_rad_s, Group::gyro_bias, Group::gyro_scale, Group::gyro_misalignment);
}

Vector3d corrected_force(const StateIndex& index, const std::array<double, kMaxStates>& x,
                         const Vector3d& measured_m_s2) {
  return corrected(index, x, measured_m_s2, Group::accel_bias, Group::accel_scale, Group::accel_misalignment);
}

}  // namespace fathom::estimation

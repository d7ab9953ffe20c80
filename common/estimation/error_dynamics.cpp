#include "estimation/error_dynamics.hpp"

#include <cmath>

namespace fathom::estimation {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix9 error_dynamics(const NavSolution& nav, const Vector3d& f_N_m_s2) {
  // (DYN-1)
  const geo::Geodetic& p = nav.position;
  const geo::Radii radii = geo::radii(p.latitude_rad);
  const double rm = radii.meridian_m + p.altitude_m;
  const double rn = radii.normal_m + p.altitude_m;
  const double tangent = std::tan(p.latitude_rad);
  const double cosine = std::cos(p.latitude_rad);
  const double sine = std::sin(p.latitude_rad);
  const double vn = nav.v_N_m_s.x();
  const double ve = nav.v_N_m_s.y();
  const double vd = nav.v_N_m_s.z();

  // How the rates of the Earth (W) and of N (E by position, Ev by velocity) change with the error.
  Matrix3d w = Matrix3d::Zero();
  w(0, 0) = -geo::kEarthRate_rad_s * sine / rm;
  w(2, 0) = -geo::kEarthRate_rad_s * cosine / rm;
  Matrix3d e = Matrix3d::Zero();
  e(0, 2) = ve / (rn * rn);
  e(1, 2) = -vn / (rm * rm);
  e(2, 0) = -ve / (rm * rn * cosine * cosine);
  e(2, 2) = -ve * tangent / (rn * rn);
  Matrix3d ev = Matrix3d::Zero();
  ev(0, 1) = 1.0 / rn;
  ev(1, 0) = -1.0 / rm;
  ev(2, 1) = -tangent / rn;

  const Vector3d rate_ie = geo::earth_rate_N(p.latitude_rad);
  const Vector3d rate_en = geo::transport_rate_N(p, nav.v_N_m_s);
  const Matrix3d v_cross = geo::skew(nav.v_N_m_s);

  Matrix9 f = Matrix9::Zero();
  f(0, 0) = -vd / rm;
  f(0, 2) = vn / rm;
  f(1, 0) = ve * tangent / rm;
  f(1, 1) = -vd / rn - vn * tangent / rn;
  f(1, 2) = ve / rn;
  f.block<3, 3>(0, 3).setIdentity();
  f.block<3, 3>(3, 0) = v_cross * (2.0 * w + e);
  f(5, 2) += 2.0 * geo::gravity(p.latitude_rad, p.altitude_m) / std::sqrt(rm * rn);
  f.block<3, 3>(3, 3) = v_cross * ev - geo::skew(2.0 * rate_ie + rate_en);
  f.block<3, 3>(3, 6) = geo::skew(f_N_m_s2);
  f.block<3, 3>(6, 0) = w + e;
  f.block<3, 3>(6, 3) = ev;
  f.block<3, 3>(6, 6) = -geo::skew(rate_ie + rate_en);
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
  Vector3d excess = Vector3d::Zero();
  if (const int s = index.of(scale); s >= 0)
    excess += Vector3d(at(s) * v.x(), at(s + 1) * v.y(), at(s + 2) * v.z());
  if (const int m = index.of(misalignment); m >= 0) {
    Eigen::Matrix<double, 6, 1> states;
    for (int i = 0; i < 6; ++i) states(i) = at(m + i);
    excess += misalignment_columns(v) * states;
  }
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

#include "study/consistency/truth_path.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace fathom::study {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Half the base of a central difference: the truth moves by 1e-7 of an acceleration with its square.
constexpr double kHalf_s = 1e-3;

const Vector3d kEarthRate_E(0.0, 0.0, ecef::kTurnRate_rad_s);

}  // namespace

TruthPath::TruthPath(const Manoeuvres& manoeuvres, const ecef::Geodetic& start)
    : manoeuvres_(&manoeuvres), r_E_m_(ecef::to_cartesian(start)), now_(felt(0.0, r_E_m_)) {}

Vector3d TruthPath::velocity_E_m_s(double t_s, const Vector3d& r_E_m) const {
  return ecef::axes_EN(ecef::to_geodetic(r_E_m)) * manoeuvres_->velocity_N_m_s(t_s);
}

Matrix3d TruthPath::axes_EB(double t_s, const Vector3d& r_E_m) const {
  return ecef::axes_EN(ecef::to_geodetic(r_E_m)) * manoeuvres_->axes_NB(t_s);
}

Vector3d TruthPath::turn_EB_B_rad_s(double t_s, const Vector3d& r_E_m) const {
  const Vector3d v_E = velocity_E_m_s(t_s, r_E_m);
  const Matrix3d turned = axes_EB(t_s - kHalf_s, r_E_m - kHalf_s * v_E).transpose() *
                          axes_EB(t_s + kHalf_s, r_E_m + kHalf_s * v_E);
  const Vector3d axis =
      0.5 * Vector3d(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1));
  const double sine = axis.norm();
  const double stretch = sine > 1e-9 ? std::asin(sine) / sine : 1.0;
  return stretch / (2.0 * kHalf_s) * axis;
}

TruthPath::Felt TruthPath::felt(double t_s, const Vector3d& r_E_m) const {
  const Vector3d v_E = velocity_E_m_s(t_s, r_E_m);
  const Vector3d change_E = (velocity_E_m_s(t_s + kHalf_s, r_E_m + kHalf_s * v_E) -
                             velocity_E_m_s(t_s - kHalf_s, r_E_m - kHalf_s * v_E)) /
                            (2.0 * kHalf_s);
  const Vector3d against_stars_E =
      change_E + 2.0 * kEarthRate_E.cross(v_E) + kEarthRate_E.cross(kEarthRate_E.cross(r_E_m));
  const Matrix3d axes = axes_EB(t_s, r_E_m);
  return {turn_EB_B_rad_s(t_s, r_E_m) + axes.transpose() * kEarthRate_E,
          axes.transpose() * (against_stars_E - ecef::gravitation_E_m_s2(r_E_m))};
}

PerfectIncrements TruthPath::advance(double dt_s) {
  const double middle_s = t_s_ + 0.5 * dt_s;
  const double end_s = t_s_ + dt_s;
  const Vector3d k1 = velocity_E_m_s(t_s_, r_E_m_);
  const Vector3d k2 = velocity_E_m_s(middle_s, r_E_m_ + 0.5 * dt_s * k1);
  const Vector3d k3 = velocity_E_m_s(middle_s, r_E_m_ + 0.5 * dt_s * k2);
  const Vector3d k4 = velocity_E_m_s(end_s, r_E_m_ + dt_s * k3);
  const Felt middle = felt(middle_s, r_E_m_ + 0.25 * dt_s * (k1 + k2));
  r_E_m_ += dt_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  const Felt end = felt(end_s, r_E_m_);
  const Felt begin = now_;
  now_ = end;
  t_s_ = end_s;
  return {dt_s / 6.0 * (begin.rate_IB_B_rad_s + 4.0 * middle.rate_IB_B_rad_s + end.rate_IB_B_rad_s),
          dt_s / 6.0 * (begin.force_B_m_s2 + 4.0 * middle.force_B_m_s2 + end.force_B_m_s2)};
}

Pose TruthPath::pose() const {
  Pose out;
  out.place = ecef::to_geodetic(r_E_m_);
  out.velocity_N_m_s = manoeuvres_->velocity_N_m_s(t_s_);
  out.axes_NB = manoeuvres_->axes_NB(t_s_);
  out.rate_EB_B_rad_s = turn_EB_B_rad_s(t_s_, r_E_m_);
  return out;
}

}  // namespace fathom::study

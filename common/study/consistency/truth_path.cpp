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

/// Between two attitudes that are twice kHalf_s apart.
Vector3d turn_rate_B(const Matrix3d& before, const Matrix3d& after) {
  const Matrix3d turned = before.transpose() * after;
  const Vector3d axis =
      0.5 * Vector3d(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1));
  const double sine = axis.norm();
  const double stretch = sine > 1e-9 ? std::asin(sine) / sine : 1.0;
  return stretch / (2.0 * kHalf_s) * axis;
}

}  // namespace

TruthPath::TruthPath(const Manoeuvres& manoeuvres, const ecef::Geodetic& start)
    : manoeuvres_(&manoeuvres), r_E_m_(ecef::to_cartesian(start)), now_(felt(0.0, r_E_m_)) {}

TruthPath::Moving TruthPath::moving(double t_s, const Vector3d& r_E_m) const {
  const Movement movement = manoeuvres_->at(t_s);
  const Matrix3d axes_EN = ecef::axes_EN(ecef::to_geodetic(r_E_m));
  return {axes_EN * movement.axes_NB, axes_EN * movement.velocity_N_m_s};
}

TruthPath::Felt TruthPath::felt(double t_s, const Vector3d& r_E_m) const {
  const Moving now = moving(t_s, r_E_m);
  const Vector3d& v_E = now.velocity_E_m_s;
  const Moving before = moving(t_s - kHalf_s, r_E_m - kHalf_s * v_E);
  const Moving after = moving(t_s + kHalf_s, r_E_m + kHalf_s * v_E);
  const Vector3d change_E = (after.velocity_E_m_s - before.velocity_E_m_s) / (2.0 * kHalf_s);
  const Vector3d against_stars_E =
      change_E + 2.0 * kEarthRate_E.cross(v_E) + kEarthRate_E.cross(kEarthRate_E.cross(r_E_m));
  const Vector3d turn_EB_B = turn_rate_B(before.axes_EB, after.axes_EB);
  return {turn_EB_B, turn_EB_B + now.axes_EB.transpose() * kEarthRate_E,
          now.axes_EB.transpose() * (against_stars_E - ecef::gravitation_E_m_s2(r_E_m))};
}

PerfectIncrements TruthPath::advance(double dt_s) {
  const double middle_s = t_s_ + 0.5 * dt_s;
  const double end_s = t_s_ + dt_s;
  const Vector3d k1 = moving(t_s_, r_E_m_).velocity_E_m_s;
  const Vector3d k2 = moving(middle_s, r_E_m_ + 0.5 * dt_s * k1).velocity_E_m_s;
  const Vector3d k3 = moving(middle_s, r_E_m_ + 0.5 * dt_s * k2).velocity_E_m_s;
  const Vector3d k4 = moving(end_s, r_E_m_ + dt_s * k3).velocity_E_m_s;
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
  const Movement movement = manoeuvres_->at(t_s_);
  Pose out;
  out.place = ecef::to_geodetic(r_E_m_);
  out.velocity_N_m_s = movement.velocity_N_m_s;
  out.axes_NB = movement.axes_NB;
  out.rate_EB_B_rad_s = now_.rate_EB_B_rad_s;
  return out;
}

}  // namespace fathom::study

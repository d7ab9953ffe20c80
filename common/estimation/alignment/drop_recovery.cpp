// How the fine alignment after a drop finds its way back when the attitude it began from was far off.
#include <algorithm>
#include <cmath>

#include "estimation/alignment/drop_alignment.hpp"
#include "estimation/alignment/motion_level.hpp"
#include "geo/wgs84.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

constexpr double kFarTurn_rad = 0.06;    // a correction as large as this is no small angle ...
constexpr double kArrived_rad = 0.01;    // ... and done when the tilt is known to this
constexpr double kTurnDoubt = 0.15;      // share of it that may still be missing
constexpr double kLevel_s = 0.5;         // time constant of the accelerometers' level
constexpr double kContradicted_s = 3.0;  // measurements contradict the filter for this long ...
constexpr double kDisagree_sigma = 3.0;  // ... and its tilt is this far from the level
constexpr double kLevelTilt_rad =
    0.07;                              // 1 sigma of the level under way, what slip and thrust leave included
constexpr double kSteady_rad_s = 0.1;  // while turning faster the level means little
constexpr double kSteadySlope_m_s2 = 2.0;  // nor while the speed changes faster

}  // namespace

void DropAlignment::recentre() {
  // (ALN-15): what was learnt while the attitude was far off was learnt with the wrong slopes.
  const double turn = geo::log(turned_).norm();
  const Vector3d sigma = rpy_sigma_rad();
  if (turn < kFarTurn_rad || std::max(sigma.x(), sigma.y()) > kArrived_rad) return;
  q_NB_ = filter_.q_NB();
  const double tilt = std::pow(kTurnDoubt * turn, 2);
  start_filter(Vector3d(tilt, tilt, config_.heading_sigma_rad * config_.heading_sigma_rad).asDiagonal());
}

double DropAlignment::heading_slip(const Vector3d& rotation_N_rad) {
  // (ALN-14)
  q_release_ = geo::normalized(geo::exp(rotation_N_rad) * q_release_);
  const double slip = geo::wrap_pi(geo::to_rpy(q_release_).z() - release_heading_rad_);
  q_release_ = geo::normalized(geo::exp({0.0, 0.0, -slip}) * q_release_);
  return slip;
}

void DropAlignment::follow_level(const DropStep& step) {
  const Vector3d rate = step.rate_IB_B_rad_s;
  if (!rate.allFinite() || !step.force_B_m_s2.allFinite() || !(step.dt_s > 0.0) || !fresh(speed_at_s_)) {
    level_force_B_.setZero();
    return;
  }
  const double u = std::max(measured_speed_m_s_, kLeastSpeed_m_s);
  const Vector3d v(u, -config_.slip_per_turn_m * rate.z(),
                   config_.slip_per_turn_m * rate.y() + config_.trim_m2_s2 / u);
  const Vector3d felt = step.force_B_m_s2 - Vector3d(speed_.slope_m_s2(), 0.0, 0.0) - geo::cross(rate, v);
  const double share = level_force_B_.isZero() ? 1.0 : 1.0 - std::exp(-step.dt_s / kLevel_s);
  level_force_B_ += share * (felt - level_force_B_);
}

bool DropAlignment::captured() {
  // (ALN-20)
  if (!filtering_ || consistent()) {
    contradicted_since_s_ = -1.0;
    return false;
  }
  if (contradicted_since_s_ < 0.0) contradicted_since_s_ = time_s_;
  const bool steady = rate_NB_B_.norm() < kSteady_rad_s && std::abs(speed_.slope_m_s2()) < kSteadySlope_m_s2;
  if (time_s_ - contradicted_since_s_ < kContradicted_s || !steady || level_force_B_.isZero()) return false;
  const Vector3d down_B = geo::to_matrix(q_NB()).row(2).transpose();
  const double cosine = std::clamp(-down_B.dot(level_force_B_.normalized()), -1.0, 1.0);
  const Eigen::Matrix3d p = attitude_covariance();
  const double sigma = std::hypot(kLevelTilt_rad, std::sqrt(std::max(p(0, 0), p(1, 1))));
  return std::acos(cosine) > kDisagree_sigma * sigma;
}

Vector3d DropAlignment::restart_from_level() {
  const MotionLevel level =
      level_in_motion(level_force_B_, Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero());
  if (level.fault != LevelFault::none) return Vector3d::Zero();
  const geo::Quaternion before = q_NB();
  const geo::Quaternion levelled = geo::from_rpy({level.roll_rad, level.pitch_rad, geo::to_rpy(before).z()});
  const double slip = heading_slip(geo::log(levelled * geo::conjugate(before)));
  q_NB_ = geo::normalized(geo::exp({0.0, 0.0, -slip}) * levelled);
  const double tilt = kLevelTilt_rad * kLevelTilt_rad;
  start_filter(Vector3d(tilt, tilt, config_.heading_sigma_rad * config_.heading_sigma_rad).asDiagonal());
  contradicted_since_s_ = -1.0;
  return geo::log(q_NB_ * geo::conjugate(before));
}

}  // namespace fathom::estimation

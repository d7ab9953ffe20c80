#include "estimation/navigator/plausibility/axes_fit.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

/// Of the mean force of a block: an acceleration of 0.2 m/s^2 that no speed tells of, as swell or a heave.
constexpr double kShaken_rad = 0.02;
constexpr double kTurnShare = 0.3;  // of a turn: blocks are not instants
constexpr double kMostTurn_rad = 1.5;
constexpr double kLongestTurn_s = 8.0;

}  // namespace

void AxesFit::add(const Vector3d& down_B, const Vector3d& turn_rad, double lasted_s,
                  const BlockMotion& motion) {
  const double speed_m_s = motion.speed_m_s;
  const double length = down_B.norm();
  if (!(length > 0.0) || !std::isfinite(length) || !(turn_rad.norm() < 1e3)) {
    has_before_ = false;
    return;
  }
  const Vector3d down = down_B / length;
  if (has_before_ && speed_m_s >= 0.0 && before_.speed_m_s >= 0.0) {
    // From the middle of one block to that of another.
    const Vector3d turn = turn_rad_ + 0.5 * turn_rad;
    lasted_s_ += lasted_s;
    const Vector3d as_configured = turned_down(turn, down_before_);
    const double gained_m_s = std::abs(speed_m_s - before_.speed_m_s);
    // Two mean forces differ in N by the change of acceleration. What moves as it points accelerates by
    // turning and by gaining speed; a multicopter accelerates any way. What the noise of velocities makes is
    // none.
    const double changed_m2_s4 = (motion.acceleration_N_m_s2 - before_.acceleration_N_m_s2).squaredNorm() -
                                 motion.variance_m2_s4 - before_.variance_m2_s4;
    const double other_m_s2 =
        std::max((speed_m_s * turn.norm() + gained_m_s) / lasted_s_, std::sqrt(std::max(0.0, changed_m2_s4)));
    const double noise = std::hypot(kShaken_rad, other_m_s2 / kStandardGravity_m_s2);
    const double moved = (down - down_before_).norm();
    if (std::max(moved, (as_configured - down_before_).norm()) < kPairStandsOut * noise &&
        lasted_s_ < kLongestTurn_s && turn.norm() < kMostTurn_rad) {
      turn_rad_ += turn_rad;
      return;
    }
    for (std::size_t i = 1; i < kAxesHypotheses && turn.norm() < kMostTurn_rad; ++i) {
      const Vector3d expected = turned_down(axes_hypothesis(i).M * turn, down_before_);
      const double apart = (expected - as_configured).norm();
      if (apart < kPairStandsOut * noise) continue;  // these two say the same
      const double variance = noise * noise + std::pow(kTurnShare * std::min(moved, apart), 2);
      count_[i] = kPairsKept * count_[i] + 1.0;
      configured_[i] = kPairsKept * configured_[i] + (down - as_configured).squaredNorm() / variance;
      left_[i] = kPairsKept * left_[i] + (down - expected).squaredNorm() / variance;
    }
  }
  has_before_ = true;
  down_before_ = down;
  turn_rad_ = 0.5 * turn_rad;
  lasted_s_ = 0.0;
  before_ = motion;
  if (!(speed_m_s >= 0.0)) before_.speed_m_s = -1.0;
}

OtherAxes AxesFit::other(const Proof& proof) const {
  OtherAxes out;
  for (std::size_t i = 1; i < kAxesHypotheses; ++i) {
    if (count_[i] < proof.fewest) continue;
    // Squares are in units of their variances, and two of the three components are free.
    const double components = 2.0 * count_[i];
    const double evidence =
        evidence_for_other(components, components, configured_[i], left_[i], proof.most_left);
    if (evidence > out.evidence) out = {i, evidence};
  }
  return out;
}

}  // namespace fathom::estimation

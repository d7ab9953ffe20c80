#include "estimation/navigator/plausibility/tilt_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/units.hpp"
#include "estimation/navigator/plausibility/pair_fit.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Longer than springs swing, shorter than a hill.
constexpr double kBlock_s = 1.5;
constexpr double kLongestTilt_s = 3.0;
constexpr double kFloor_rad = 0.005;  // 0.05 m/s^2 that no velocity tells of
constexpr double kTiltShare = 0.2;    // of what is taken off, and of what turns within a block
constexpr double kMostTilt_rad = 1.0;
constexpr double kMost_m_s = 1e4;
constexpr double kTiltStandsOut = 2.0;
/// A block is no more than this for or against anything, and its square no more than that of three sigmas:
/// one that a kerb or a bad velocity made says little.
constexpr double kMostOfABlock = 1.5;
constexpr double kMostSquare = 9.0;
/// What is not modelled, a late velocity or the bias of a gyro, lasts from block to block: half the evidence
/// allows for errors that come in twos.
constexpr double kShared = 0.5;
/// Over a gyro that says nothing: once in a thousand.
constexpr double kTurns = 6.9;

}  // namespace

void TiltFit::add(const Vector3d& dv_m_s, const Vector3d& dtheta_rad, double dt_s) {
  dv_m_s_ += dv_m_s;
  turn_rad_ += dtheta_rad;
  lasted_s_ += dt_s;
}

void TiltFit::interrupt() {
  has_velocity_ = has_down_ = false;
}

void TiltFit::measured(const Velocity& velocity) {
  if (has_velocity_ && lasted_s_ < kBlock_s) return;
  const bool sound = turn_rad_.norm() < kMostTilt_rad && dv_m_s_.norm() < kMost_m_s;
  if (has_velocity_ && lasted_s_ < kLongestTilt_s && sound) {
    turn_rad_ -= lasted_s_ * velocity.attitude.gyro_bias_rad_s;
    // The body in the middle of the block, seen from its end.
    const geo::Quaternion q_NM = velocity.attitude.q_NB * geo::exp(-0.5 * turn_rad_);
    const Block now{
        .force_B_m_s2 = dv_m_s_ / lasted_s_,
        .acceleration_B_m_s2 = geo::to_matrix(q_NM).transpose() * (velocity.v_N_m_s - v_N_m_s_) / lasted_s_,
        .turn_rad = turn_rad_};
    const double lever_m_s = velocity.lever_m * (now.turn_rad - turn_before_rad_).norm() / lasted_s_;
    const double noise_m_s2 = std::hypot(1.4 * velocity.noise_m_s, lever_m_s) / lasted_s_;
    follow(now, noise_m_s2 / kStandardGravity_m_s2);
  } else {
    has_down_ = false;
  }
  has_velocity_ = true;
  v_N_m_s_ = velocity.v_N_m_s;
  dv_m_s_.setZero();
  turn_rad_.setZero();
  lasted_s_ = 0.0;
}

void TiltFit::follow(const Block& now, double noise_rad) {
  const double taken_off = now.acceleration_B_m_s2.norm() / kStandardGravity_m_s2;
  const double variance =
      kFloor_rad * kFloor_rad + noise_rad * noise_rad + std::pow(kTiltShare * taken_off, 2);
  const auto down = [&](std::size_t i) {
    const Matrix3d& A = axes_hypothesis(i).A;
    return Vector3d((now.acceleration_B_m_s2 - A * now.force_B_m_s2).normalized());
  };
  if (has_down_) {
    // From the middle of one block to that of the other.
    const Vector3d turn = 0.5 * (turn_before_rad_ + now.turn_rad);
    const double tilted_rad = turn.cross(down_B_[0]).norm();
    variance_ += kFloor_rad * kFloor_rad + std::pow(kTiltShare * tilted_rad, 2);
    const double gain = variance_ / (variance_ + variance);
    std::array<double, kSeries> squares;
    for (std::size_t i = 0; i < kSeries; ++i) {
      const bool of_gyro = i < kAxesHypotheses && axes_hypothesis(i).A.isIdentity(0.0);
      const Vector3d turned = i == kNothing ? Vector3d::Zero()
                              : of_gyro     ? Vector3d(axes_hypothesis(i).M * turn)
                                            : turn;
      const Vector3d expected = turned_down(turned, down_B_[i]);
      const Vector3d innovation = down(i == kNothing ? 0 : i) - expected;
      squares[i] = 0.5 * innovation.squaredNorm() / (variance_ + variance);  // of two components
      down_B_[i] = (expected + gain * innovation).normalized();
    }
    variance_ *= 1.0 - gain;
    if (std::max(tilted_rad, taken_off) >= kTiltStandsOut * kFloor_rad) judge(squares);
  } else {
    for (std::size_t i = 0; i < kSeries; ++i) down_B_[i] = down(i == kNothing ? 0 : i);
    variance_ = variance;
    has_down_ = true;
  }
  turn_before_rad_ = now.turn_rad;
}

void TiltFit::judge(std::array<double, kSeries>& squares) {
  const double configured = squares[0];
  for (std::size_t i = 0; i < kAxesHypotheses; ++i) {
    // What the better of the two has left over until now, and at first what is expected.
    const double scale = (std::min(left_[0], left_[i]) + kFewestPairs) / (count_ + kFewestPairs);
    const auto evidence = [scale](double worse, double better) {
      return kShared * std::clamp((worse - better) / scale, -kMostOfABlock, kMostOfABlock);
    };
    if (count_ >= kFewestPairs) {
      over_configured_[i] = kPairsKept * over_configured_[i] + evidence(configured, squares[i]);
      over_nothing_[i] = kPairsKept * over_nothing_[i] + evidence(squares[kNothing], squares[i]);
    }
    squares[i] = std::min(squares[i], kMostSquare * scale);
  }
  for (std::size_t i = 0; i < kAxesHypotheses; ++i) left_[i] = kPairsKept * left_[i] + squares[i];
  count_ = kPairsKept * count_ + 1.0;
}

OtherAxes TiltFit::other() const {
  OtherAxes out;
  for (std::size_t i = 1; i < kAxesHypotheses; ++i)
    if (over_configured_[i] > out.evidence && over_nothing_[i] > kTurns) out = {i, over_configured_[i]};
  return out;
}

}  // namespace fathom::estimation

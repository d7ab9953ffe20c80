#pragma once

#include <array>

#include <Eigen/Core>

#include "estimation/navigator/plausibility/axes_hypotheses.hpp"
#include "estimation/navigator/plausibility/pair_fit.hpp"

namespace fathom::estimation {

/// What is known of how the mean force of a block differs from gravity.
struct BlockMotion {
  double speed_m_s = -1.0;  ///< at its end; negative or unknown: nobody measures it
  /// Over ground, and the variance of it, both components together; 0 where no velocity tells.
  Eigen::Vector2d acceleration_N_m_s2 = Eigen::Vector2d::Zero();
  double variance_m2_s4 = 0.0;
};

/// Whether gravity turns in the body as the gyro says, and which exchange or sign of axes would explain it
/// better. A value of fixed size.
class AxesFit {
 public:
  /// One block of some `lasted_s`: where down is on average (any length), and the sum of the gyro's
  /// increments. Without a speed the block says nothing.
  void add(const Eigen::Vector3d& down_B, const Eigen::Vector3d& turn_rad, double lasted_s,
           const BlockMotion& motion);
  void interrupt() { has_before_ = false; }
  /// The best explanation besides "as configured"; no evidence where that is not refuted.
  [[nodiscard]] OtherAxes other(const Proof& proof) const;

  /// For archives: see fields/plausibility.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  bool has_before_ = false;
  Eigen::Vector3d down_before_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_rad_ = Eigen::Vector3d::Zero();  ///< since
  double lasted_s_ = 0.0;
  BlockMotion before_;
  // Of each hypothesis, over the pairs in which it differs from "as configured": squares in sigma.
  std::array<double, kAxesHypotheses> count_{};
  std::array<double, kAxesHypotheses> configured_{};
  std::array<double, kAxesHypotheses> left_{};
};

}  // namespace fathom::estimation

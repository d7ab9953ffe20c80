#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace fathom::estimation {

/// Which exchange or sign of axes a hypothesis assumes. The first one is "as configured".
inline constexpr std::size_t kAxesHypotheses = 13;

struct AxesHypothesis {
  Eigen::Matrix3d M;   ///< the gyro's axes as they should be, by those as they are
  const char* remedy;  ///< what makes it right: "exchange gyro x and y"
  Eigen::Matrix3d A;   ///< the accelerometer's, where it is them; identity where it is the gyro's
};

[[nodiscard]] const AxesHypothesis& axes_hypothesis(std::size_t number);

/// The best explanation besides "as configured".
struct OtherAxes {
  std::size_t number = 0;
  double evidence = 0.0;  ///< log likelihood ratio against "as configured"
};

/// Where down comes to lie in a body that turns.
[[nodiscard]] Eigen::Vector3d turned_down(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& down);

}  // namespace fathom::estimation

#pragma once

#include <array>
#include <vector>

#include "commission/assumed.hpp"
#include "commission/finding.hpp"
#include "commission/fit/allan.hpp"
#include "commission/fit/rest.hpp"
#include "commission/fit/series.hpp"

namespace fathom::commission {

/// Rate, gaps, and at rest noise and bias of the inertial unit.
struct ImuNoise {
  Findings findings;
  std::array<std::vector<AllanPoint>, 3> gyro;   ///< rad/s, of the longest rest
  std::array<std::vector<AllanPoint>, 3> force;  ///< m/s^2
  Eigen::Vector3d rate_bias = Eigen::Vector3d::Zero();
  double angle_random_walk = 1e-4;  ///< rad/sqrt(s): of the noisiest axis, or that of an ordinary MEMS unit
  double velocity_random_walk = 2e-3;  ///< (m/s)/sqrt(s)
};
[[nodiscard]] ImuNoise check_imu_noise(const Series& series, const Assumed& assumed,
                                       const std::vector<Span>& rest);

}  // namespace fathom::commission

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
};
[[nodiscard]] ImuNoise check_imu_noise(const Series& series, const Assumed& assumed,
                                       const std::vector<Span>& rest);

}  // namespace fathom::commission

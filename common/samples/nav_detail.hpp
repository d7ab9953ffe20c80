#pragma once

#include <array>
#include <cstdint>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// One estimated quantity with its standard deviation, SI units.
struct StateEstimate {
  Name name;  ///< e.g. "gyro_bias_x_rad_s"
  double value = kUnknown;
  double sigma = kUnknown;
};

/// Everything the filter estimates, error states by name in the order of the covariance diagonal.
struct NavDetail {
  static constexpr std::size_t kMaxStates = 64;
  SampleHeader header;
  Name configuration;  ///< named state configuration, e.g. "hybrid25"
  std::uint32_t count = 0;
  std::array<StateEstimate, kMaxStates> states{};
};

}  // namespace fathom

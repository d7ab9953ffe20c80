#pragma once

#include <array>
#include <cstdint>

namespace fathom::estimation {

/// So many sigmas leave no doubt that what was said is wrong.
inline constexpr double kCertain = 5.0;
/// A large error is found in steps. One that is never found is another one.
inline constexpr std::uint32_t kMostCorrections = 3;

/// Evidence of one error in blocks: of each, gradient g and curvature J of the logarithm of the likelihood.
struct Scatter {
  std::array<double, 3> sums{};  ///< of g^2, g J and J^2

  void add(double gradient, double curvature) {
    sums[0] += gradient * gradient;
    sums[1] += gradient * curvature;
    sums[2] += curvature * curvature;
  }
  /// The sum of (g - e J)^2 for an error e: how far the blocks are from saying it together.
  [[nodiscard]] double about(double error) const {
    return sums[0] - 2.0 * error * sums[1] + error * error * sums[2];
  }
  /// So many blocks have a say in the `curvature` of all that no single one decides.
  [[nodiscard]] bool are_enough(double curvature) const {
    constexpr double kLeast = 3.0;
    return curvature * curvature > kLeast * sums[2];
  }
};

}  // namespace fathom::estimation

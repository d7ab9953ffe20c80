#pragma once

#include <array>
#include <cstddef>

#include "estimation/filter/error_filter.hpp"

namespace fathom::estimation {

// For N of 1 and 6: see followed.cpp.

/// What the filter has made by now of `N` errors of an earlier instant: by states, a column for each.
template <std::size_t N>
using FollowedErrors = std::array<double, static_cast<std::size_t>(kMaxStates) * N>;

/// What a measurement says of such errors, each for itself, if there were none: gradient of the logarithm of
/// the likelihood, and how fast that falls.
template <std::size_t N>
struct Evidence {
  Evidence(const FollowedErrors<N>& errors, const Observation& observation,
           const InnovationStatistics& statistics);

  Eigen::Matrix<double, Eigen::Dynamic, static_cast<int>(N), 0, Observation::kMaxRows, static_cast<int>(N)>
      weighed;  ///< S^-1 H u
  std::array<double, N> gradient{};
  std::array<double, N> curvature{};
};

/// What one sigma of each error that the filter considers and does not estimate makes of `N` sums of
/// gradients. Such an error is the same in all measurements, so that it does not average out.
template <std::size_t N>
struct Considered {
  std::array<double, N* static_cast<std::size_t>(kMaxStates)> sums{};

  /// To sum `i` has been added the gradient `j` of `evidence`.
  template <std::size_t M>
  void add(std::size_t i, const Evidence<M>& evidence, std::size_t j, const InnovationStatistics& statistics,
           const ErrorFilter& filter);
  void fade(double kept) {
    for (double& one : sums) one *= kept;
  }
  /// Of sum `i`, which would be `own` without them: for gradients their curvature.
  [[nodiscard]] double variance(std::size_t i, double own) const {
    double out = own;
    for (std::size_t c = i * kMaxStates; c < (i + 1) * kMaxStates; ++c) out += sums[c] * sums[c];
    return out;
  }
};

// What the filter does, in its order.
template <std::size_t N>
void follow(const NavTransition& step, const ProcessNoise& noise, FollowedErrors<N>& errors);
/// A measurement that says `evidence` has been taken in; the first `estimated` states have moved.
template <std::size_t N>
void follow(const Evidence<N>& evidence, const InnovationStatistics& statistics, int estimated,
            FollowedErrors<N>& errors);
template <std::size_t N>
void follow(const Carry& carry, FollowedErrors<N>& errors);

}  // namespace fathom::estimation

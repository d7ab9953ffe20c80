#pragma once

#include <gtest/gtest.h>

#include "estimation/filter/error_filter.hpp"

namespace fathom::estimation {

/// A linear filter whose estimated errors are taken out of what is really wrong, as a navigator does.
struct LinearLoop {
  using Noise = Eigen::Matrix<double, Observation::kMaxRows, 1>;

  explicit LinearLoop(const ErrorFilter& at_start)
      : filter(at_start), error(Eigen::VectorXd::Zero(at_start.size())) {}

  ErrorFilter filter;
  Eigen::VectorXd error;  ///< what is left of it

  /// `columns`: of the states that the step knows.
  void propagate_error(const NavTransition& step, int columns) {
    error.head<kNavStates>() = (step.rows(columns) * error.head(columns)).eval();
  }
  /// Sees the error with this noise. `updated(observation, statistics)` hears what the filter does.
  template <class Updated>
  void take_in(Observation observation, const Noise& noise, const Updated& updated) {
    for (std::size_t r = 0; r < static_cast<std::size_t>(observation.rows); ++r) {
      observation.innovation[r] = noise(static_cast<Eigen::Index>(r));
      for (Eigen::Index i = 0; i < error.size(); ++i)
        observation.innovation[r] += observation.h[r][static_cast<std::size_t>(i)] * error(i);
    }
    InnovationStatistics statistics;
    filter.statistics(observation, 1.0, statistics);
    std::array<double, kMaxStates> x{};
    ASSERT_TRUE(filter.update(observation, statistics, x));
    updated(observation, statistics);
    remove(x);
  }
  void take_in(const Observation& observation, const Noise& noise) {
    take_in(observation, noise, [](const Observation&, const InnovationStatistics&) {});
  }
  void remove(const std::array<double, kMaxStates>& x) {
    for (Eigen::Index i = 0; i < error.size(); ++i) error(i) -= x[static_cast<std::size_t>(i)];
  }
};

}  // namespace fathom::estimation

#pragma once

#include <gtest/gtest.h>

#include "estimation/filter/error_filter.hpp"
#include "support/vehicles/analytic_vehicle.hpp"

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
  /// Sees the velocity, each component `off` and with a noise of `sigma`.
  template <class Updated>
  void see_velocity(double sigma, double off, test::Normal& normal, const Updated& updated) {
    Observation seen;
    seen.rows = 3;
    Noise drawn = Noise::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      seen.h[i][3 + i] = 1.0;
      seen.sigma[i] = sigma;
      drawn(static_cast<Eigen::Index>(i)) = off + normal(sigma);
    }
    seen.list_columns(filter.size());
    take_in(seen, drawn, updated);
  }
  void see_velocity(double sigma, test::Normal& normal) {
    see_velocity(sigma, 0.0, normal, [](const Observation&, const InnovationStatistics&) {});
  }
  void remove(const std::array<double, kMaxStates>& x) {
    for (Eigen::Index i = 0; i < error.size(); ++i) error(i) -= x[static_cast<std::size_t>(i)];
  }
};

}  // namespace fathom::estimation

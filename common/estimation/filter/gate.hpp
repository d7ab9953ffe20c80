#pragma once

#include <array>

#include "base/unknown.hpp"
#include "estimation/filter/chi_square.hpp"
#include "estimation/filter/error_filter.hpp"

namespace fathom::estimation {

/// Limits of one sensor, made once from its configuration.
struct GateLimits {
  std::array<double, Observation::kMaxRows + 1> chi_square{};  ///< by number of rows
};
[[nodiscard]] GateLimits gate_limits(const SensorConfig& sensor);

struct GateResult {
  bool pass = false;
  double test_ratio = kUnknown;  ///< squared distance over its limit
  double limit = kUnknown;
  unsigned refused = 0;  ///< the rows that were not accepted, a bit each
  /// Of each row of the observation as it came, before any widening.
  std::array<double, Observation::kMaxRows> innovation_sigma{};
};

/// Tests an innovation (GATE-1). With robust weighting the noise is first widened as far as the innovation
/// calls for (GATE-2); with GateMode::per_component the rows that fail are taken out of `observation`, and it
/// passes when any is left. `statistics` is what the update must use afterwards: H P is worked out once, what
/// is decided afterwards changes only R and which rows there are.
[[nodiscard]] GateResult gate(const ErrorFilter& filter, const SensorConfig& sensor, const GateLimits& limits,
                              Observation& observation, InnovationStatistics& statistics);
/// The same with `statistics` that are there already, of all rows and their own noise.
[[nodiscard]] GateResult gate(const SensorConfig& sensor, const GateLimits& limits, Observation& observation,
                              InnovationStatistics& statistics);

}  // namespace fathom::estimation

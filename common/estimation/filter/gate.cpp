#include "estimation/filter/gate.hpp"

#include <algorithm>
#include <cmath>

#include "base/unknown.hpp"

namespace fathom::estimation {
namespace {

/// Of the squared distance, where everything is to pass.
constexpr double kNoLimit = 1e30;

double noise_scale(const SensorConfig& sensor, double squared_distance, int rows) {
  // (GATE-2)
  switch (sensor.robust) {
    case RobustKind::student_t:
      return std::max(1.0, (sensor.robust_parameter + squared_distance) / (sensor.robust_parameter + rows));
    case RobustKind::huber: {
      const double distance = std::sqrt(squared_distance);
      return std::max(1.0, distance / sensor.robust_parameter);
    }
    case RobustKind::none:
      break;
  }
  return 1.0;
}

void drop_row(Observation& observation, int row) {
  for (int i = row; i + 1 < observation.rows; ++i) {
    const auto to = static_cast<std::size_t>(i);
    observation.innovation[to] = observation.innovation[to + 1];
    observation.sigma[to] = observation.sigma[to + 1];
    observation.component[to] = observation.component[to + 1];
    observation.h[to] = observation.h[to + 1];
  }
  --observation.rows;
}

/// The statistics of those rows alone.
void keep_rows(InnovationStatistics& statistics, unsigned refused) {
  std::size_t kept = 0;
  std::array<std::size_t, kStatisticsStride> from{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(statistics.rows); ++i)
    if ((refused & 1U << i) == 0) from[kept++] = i;
  for (std::size_t i = 0; i < kept; ++i) {
    statistics.noise[i] = statistics.noise[from[i]];
    for (std::size_t j = 0; j < kept; ++j)
      statistics.s[i * kStatisticsStride + j] = statistics.s[from[i] * kStatisticsStride + from[j]];
    if (from[i] != i)
      std::copy_n(statistics.ph.data() + from[i] * kMaxStates, kMaxStates,
                  statistics.ph.data() + i * kMaxStates);
  }
  statistics.rows = static_cast<int>(kept);
}

}  // namespace

GateLimits gate_limits(const SensorConfig& sensor) {
  GateLimits limits;
  for (int rows = 1; rows <= Observation::kMaxRows; ++rows)
    limits.chi_square[static_cast<std::size_t>(rows)] =
        sensor.gate_probability < 1.0 ? chi_square_quantile(sensor.gate_probability, rows) : kNoLimit;
  return limits;
}

GateResult gate(const ErrorFilter& filter, const SensorConfig& sensor, const GateLimits& limits,
                Observation& observation, InnovationStatistics& statistics) {
  filter.statistics(observation, 1.0, statistics);
  return gate(sensor, limits, observation, statistics);
}

GateResult gate(const SensorConfig& sensor, const GateLimits& limits, Observation& observation,
                InnovationStatistics& statistics) {
  GateResult result;
  for (std::size_t i = 0; i < static_cast<std::size_t>(statistics.rows); ++i)
    result.innovation_sigma[i] = std::sqrt(statistics.s[i * kStatisticsStride + i]);
  if (observation.each_alone || sensor.gate_mode == GateMode::per_component) {
    // (GATE-1), each component on its own.
    result.limit = limits.chi_square[1];
    double worst_kept = 0.0;
    double best_dropped = HUGE_VAL;
    int row = 0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(statistics.rows); ++i) {
      const double z = observation.innovation[static_cast<std::size_t>(row)];
      const double squared = z * z / statistics.s[i * kStatisticsStride + i];
      const bool hopeless = squared > sensor.robust_reject_ratio * result.limit;
      const double scale = hopeless ? 1.0 : noise_scale(sensor, squared, 1);
      const double sigma = observation.sigma[static_cast<std::size_t>(row)];
      const double s = statistics.s[i * kStatisticsStride + i] + (scale - 1.0) * sigma * sigma;
      const double ratio = z * z / s / result.limit;
      if (ratio <= 1.0) {
        observation.sigma[static_cast<std::size_t>(row)] = std::sqrt(scale) * sigma;
        statistics.s[i * kStatisticsStride + i] = s;
        statistics.noise[i] = scale * sigma * sigma;
        worst_kept = std::max(worst_kept, ratio);
        ++row;
      } else if (observation.rows == 1) {
        result.refused |= 1U << i;
        result.test_ratio = std::min(best_dropped, ratio);
        return result;
      } else {
        result.refused |= 1U << i;
        best_dropped = std::min(best_dropped, ratio);
        drop_row(observation, row);
      }
    }
    result.pass = true;
    result.test_ratio = worst_kept;
    if (result.refused != 0) keep_rows(statistics, result.refused);
    statistics.squared_distance = squared_distance(observation, statistics);
    return result;
  }
  result.limit = limits.chi_square[static_cast<std::size_t>(observation.rows)];
  const bool hopeless = statistics.squared_distance > sensor.robust_reject_ratio * result.limit;
  const double scale = hopeless ? 1.0 : noise_scale(sensor, statistics.squared_distance, observation.rows);
  if (scale > 1.0 && std::isfinite(scale)) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(statistics.rows); ++i) {
      statistics.s[i * kStatisticsStride + i] += (scale - 1.0) * observation.sigma[i] * observation.sigma[i];
      statistics.noise[i] *= scale;
    }
    statistics.squared_distance = squared_distance(observation, statistics);
  }
  result.test_ratio = statistics.squared_distance / result.limit;
  result.pass = result.test_ratio <= 1.0;
  if (!result.pass) result.refused = (1U << observation.rows) - 1U;
  return result;
}

}  // namespace fathom::estimation

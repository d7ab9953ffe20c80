#pragma once

#include <cmath>
#include <optional>

namespace fathom::commission {

/// Of every sigma of a fit, for what no model here has.
inline constexpr double kModelMargin = 1.25;
/// Of an integration around a window: latencies up to this.
inline constexpr double kWindowMargin_s = 2.0;
/// No latency is known better.
inline constexpr double kLeastLatency_s = 5e-4;

/// The latency of the least sum of squares among -steps * step_s ... steps * step_s; 0 where none is less.
template <class Squares>
[[nodiscard]] double scan_latency(double step_s, int steps, const Squares& squares) {
  double best_s = 0.0;
  double least = squares(0.0);
  for (int step = -steps; step <= steps; ++step) {
    const double now = squares(step_s * step);
    if (!(now < least)) continue;
    least = now;
    best_s = step_s * step;
  }
  return best_s;
}

struct LatencyFit {
  double latency_s = 0.0;
  double sigma_s = 0.0;
};

/// The least of the parabola through the sums of squares of `count` differences at a latency and `h_s` before
/// and behind it. Nothing where it has none.
[[nodiscard]] inline std::optional<LatencyFit> parabola(double latency_s, double h_s, double before,
                                                        double at, double behind, double count) {
  const double curvature = (before - 2.0 * at + behind) / (h_s * h_s);
  if (!(curvature > 0.0)) return std::nullopt;
  return LatencyFit{latency_s - (behind - before) / (2.0 * h_s) / curvature,
                    std::sqrt(2.0 * at / count / curvature)};
}

}  // namespace fathom::commission

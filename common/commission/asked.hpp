#pragma once

#include <algorithm>
#include <cmath>

namespace fathom::commission {

// How well a figure has to be told before a log is said to know it.
inline constexpr double kAskedTurn_deg = 0.2;
inline constexpr double kAskedLever_m = 0.05;
inline constexpr double kAskedLatency_s = 0.005;
// How many sigmas of it that takes.
inline constexpr double kAskedSigmas = 2.5;

[[nodiscard]] inline bool known_to(double asked, double sigma) {
  return kAskedSigmas * sigma < asked;
}

// And by how much a figure has to differ from what is configured before anybody notices.
inline constexpr double kNoticedTurn_deg = 0.3;
inline constexpr double kNoticedLever_m = 0.03;
inline constexpr double kNoticedLatency_s = 0.004;

// A figure is written into a configuration where it differs from what stands there by more than it is
// uncertain and by more than anybody would notice.
[[nodiscard]] inline bool differs(double off, double sigma, double noticed) {
  return std::abs(off) > std::max(noticed, 4.0 * sigma);
}

}  // namespace fathom::commission

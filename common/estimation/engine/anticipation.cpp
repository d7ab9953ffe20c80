#include "estimation/engine/anticipation.hpp"

#include <algorithm>
#include <cstdlib>
#include <span>

namespace fathom::estimation {
namespace {

/// An instrument so fast is met by snapshots that stand close everywhere.
constexpr DurationNs kFastestSteps = 4;
/// So many in a row may be lost, and the period is still that of before.
constexpr DurationNs kMostLost = 4;
/// After so many nobody waits for the next one.
constexpr DurationNs kPatience = 16;
/// Stamps jitter by so much less than a step.
constexpr DurationNs kJitterShare = 2;

}  // namespace

void Anticipation::heard(const Measurement& measurement, TimeNs newest_ns) {
  if (measurement.command || measurement.sensor < 0) return;
  const auto sensor = static_cast<std::size_t>(measurement.sensor);
  Expected& one = expected_[sensor];
  heard_ = std::max(heard_, sensor + 1);
  const DurationNs gap = measurement.stamp_ns - one.stamp_ns;
  if (one.stamp_ns != 0 && gap <= 0) return;  // another part of the same message, or out of order
  if (one.stamp_ns != 0) {
    const DurationNs periods =
        one.period_ns == 0 ? 1
                           : std::clamp((gap + one.period_ns / 2) / one.period_ns, DurationNs{1}, kMostLost);
    const bool is_known = std::abs(gap - periods * one.period_ns) < one.period_ns / 4;
    one.period_ns = is_known ? gap / periods : gap;
  }
  one.stamp_ns = measurement.stamp_ns;
  one.delay_ns = newest_ns - measurement.stamp_ns;
}

TimeNs Anticipation::expected_until_ns(TimeNs now_ns, DurationNs dt_ns) const {
  const DurationNs margin = dt_ns / kJitterShare;
  TimeNs until_ns = 0;
  for (const Expected& one : std::span(expected_).first(heard_)) {
    if (one.period_ns <= 0 || one.period_ns < kFastestSteps * dt_ns || one.delay_ns < 0) continue;
    const DurationNs since = now_ns + margin - one.stamp_ns;
    if (since < 0 || since > kPatience * one.period_ns) continue;
    // Mostly the next one or the one after it; a division costs as much as all the rest.
    const DurationNs passed = since < one.period_ns       ? 0
                              : since < 2 * one.period_ns ? 1
                                                          : since / one.period_ns;
    const TimeNs next_ns = one.stamp_ns + (passed + 1) * one.period_ns;
    if (next_ns > now_ns + margin + dt_ns) continue;
    until_ns = std::max(until_ns, next_ns + one.delay_ns + dt_ns);
  }
  return until_ns;
}

}  // namespace fathom::estimation

#include "health/navigation/forecast_watch.hpp"

#include <algorithm>

namespace fathom::health {
namespace {

constexpr double kFreshS = 5.0;  // forecasts come once a second

/// Keeps since when a condition has held without a break.
void track(bool holds, bool& held, TimeNs& since_ns, TimeNs now_ns) {
  if (holds && !held) since_ns = now_ns;
  held = holds;
}

}  // namespace

void ForecastWatch::add(const Forecast& forecast, const Instant& now) {
  const auto count = std::min<std::size_t>(forecast.limit_count, Forecast::kMaxLimits);
  for (std::size_t i = 0; i < count; ++i) {
    const ForecastLimit& limit = forecast.limits[i];
    if (limit.name != config_.limit || config_.limit.empty() || !limit.without.empty()) continue;
    const bool gap = !fresh(now);
    heard_ = true;
    heard_ns_ = now.monotonic_ns;
    time_to_limit_s_ = limit.time_to_limit_s;
    if (gap) below_warning_ = below_critical_ = false;
    track(time_to_limit_s_ < config_.warning_s, below_warning_, warning_since_ns_, now.monotonic_ns);
    track(time_to_limit_s_ < config_.critical_s, below_critical_, critical_since_ns_, now.monotonic_ns);
    return;
  }
}

bool ForecastWatch::fresh(const Instant& now) const {
  return heard_ && to_seconds(now.monotonic_ns - heard_ns_) < kFreshS;
}

Severity ForecastWatch::severity(const Instant& now) const {
  if (!fresh(now)) return Severity::notice;
  const auto long_enough = [&](bool held, TimeNs since_ns) {
    return held && to_seconds(now.monotonic_ns - since_ns) >= config_.hold_s;
  };
  if (long_enough(below_critical_, critical_since_ns_)) return Severity::critical;
  if (long_enough(below_warning_, warning_since_ns_)) return Severity::warning;
  return Severity::notice;
}

double ForecastWatch::time_to_limit_s(const Instant& now) const {
  return fresh(now) ? time_to_limit_s_ : kUnknown;
}

}  // namespace fathom::health

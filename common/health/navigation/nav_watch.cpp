#include "health/navigation/nav_watch.hpp"

#include <algorithm>
#include <cmath>

#include "health/text.hpp"
#include "samples/position/gives_position.hpp"
#include "samples/uncertainty.hpp"

namespace fathom::health {
namespace {

StreamLimits limits_of(const NavWatchConfig& config) {
  StreamLimits limits = StreamLimits::from_rate(config.rate_hz);
  limits.missing_s = config.missing_s;
  limits.stale_s = std::min(limits.stale_s, config.missing_s);
  return limits;
}

template <std::size_t N>
bool all_finite(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

NavWatch::NavWatch(const NavWatchConfig& config, double startup_s, const Instant& start)
    : config_(config), startup_s_(startup_s), stream_(limits_of(config), start.monotonic_ns) {}

void NavWatch::add(const NavState& state, const Instant& now) {
  if (stream_.ever_heard() && state.header.stamp_ns == last_stamp_ns_) return;
  last_stamp_ns_ = state.header.stamp_ns;
  stream_.heard(now.monotonic_ns);
  mode_ = state.mode;
  invalid_ =
      gives_position(mode_) && !(std::isfinite(state.latitude_rad) && std::isfinite(state.longitude_rad) &&
                                 all_finite(state.velocity_N_m_s) && all_finite(state.q_NB));
  horizontal_95_m_ =
      gives_position(mode_) ? fathom::horizontal_95_m(state.position_covariance_N_m2) : kUnknown;
  const double limit_m = config_.horizontal_95_limit_m;
  uncertain_ = horizontal_95_m_ > (uncertain_ ? 0.9 * limit_m : limit_m);
}

void NavWatch::evaluate(const Instant& now) {
  stream_.evaluate(now.monotonic_ns);
}

NavMode NavWatch::mode() const {
  return stream_.presence() == Presence::missing ? NavMode::none : mode_;
}

double NavWatch::horizontal_95_m() const {
  return stream_.presence() == Presence::missing ? kUnknown : horizontal_95_m_;
}

void NavWatch::report(AlarmBook& book, const Instant& now) const {
  if (!config_.expected) return;
  const double silent_s = stream_.silent_s(now.monotonic_ns);
  const bool unseen = !stream_.ever_heard() && silent_s > std::max(startup_s_, config_.missing_s);
  const bool missing = stream_.presence() == Presence::missing;
  book.set(missing || unseen,
           {.key = "nav_state_missing",
            .severity = Severity::critical,
            .text = sentence("There has been no navigation state for %s%s (limit %s).",
                             duration_text(silent_s).c_str(), unseen ? ", never since the start" : "",
                             duration_text(config_.missing_s).c_str()),
            .value = silent_s,
            .limit = config_.missing_s,
            .began_ago_s = silent_s},
           now);
  const double rate_hz = stream_.rate_hz(now.monotonic_ns);
  book.set(stream_.slow(),
           {.key = "nav_state_slow",
            .severity = Severity::warning,
            .text = sentence("The navigation state comes %.3g times a second instead of %.3g.", rate_hz,
                             config_.rate_hz),
            .value = rate_hz,
            .limit = 0.5 * config_.rate_hz},
           now);
  book.set(invalid_ && !missing,
           {.key = "nav_state_invalid",
            .severity = Severity::critical,
            .text = sentence("The navigation state claims mode %s but its values are not finite.",
                             std::string(to_string(mode_)).c_str())},
           now);
  book.set(uncertain_ && !missing,
           {.key = "nav_uncertain",
            .severity = Severity::warning,
            .text = sentence("The horizontal position is certain only to %.0f m (95 %%, limit %.0f m).",
                             horizontal_95_m_, config_.horizontal_95_limit_m),
            .value = horizontal_95_m_,
            .limit = config_.horizontal_95_limit_m},
           now);
}

}  // namespace fathom::health

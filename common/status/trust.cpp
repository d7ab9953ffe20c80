#include "status/trust.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "health/text.hpp"
#include "samples/position/gives_position.hpp"
#include "samples/uncertainty.hpp"
#include "status/receiver.hpp"

namespace fathom::status {
namespace {

using health::duration_text;
using health::sentence;

constexpr double kAidedS = 5.0;   // a source used within this time still carries the solution
constexpr double kSoonS = 300.0;  // a limit passed sooner than this is worth a warning
constexpr double kMonitorFreshS = 3.0;

/// "about 11 min": a forecast has no more digits than that.
std::string about(double seconds) {
  if (seconds < 90.0) return sentence("about %.0f s", std::max(1.0, seconds));
  if (seconds < 5400.0) return sentence("about %.0f min", seconds / 60.0);
  return sentence("about %.1f h", seconds / 3600.0);
}

std::string metres(double value_m) {
  if (!std::isfinite(value_m)) return "unknown";
  return sentence(value_m < 10.0 ? "%.1f m" : "%.0f m", value_m);
}

/// What the position rests on. Fusion calls itself aided for a while after the last fix; what the monitor
/// says about GPS counts for more here, or the sentence would contradict itself.
std::string basis(const NavState& nav, bool gps_gone) {
  const bool dvl = nav.dvl_outage_s < kAidedS;
  const NavMode mode = nav.mode == NavMode::gps_aided && gps_gone ? NavMode::dead_reckoning : nav.mode;
  switch (mode) {
    case NavMode::gps_aided:
      return dvl ? "GPS with DVL" : "GPS";
    case NavMode::acoustic_aided:
      return dvl ? "USBL with DVL" : "USBL";
    case NavMode::dead_reckoning:
      return dvl ? "Dead reckoning with DVL" : "Dead reckoning without DVL";
    case NavMode::inertial:
      return "Inertial alone, nothing aids it";
    case NavMode::none:
    case NavMode::aligning:
      break;
  }
  return "No position yet";
}

/// The horizontal limit that will be passed next, as things are.
std::optional<ForecastLimit> next_limit(const StatusView& view) {
  std::optional<ForecastLimit> next;
  if (!view.forecast) return next;
  const Forecast& forecast = view.forecast->sample;
  const auto count = std::min<std::size_t>(forecast.limit_count, Forecast::kMaxLimits);
  for (std::size_t i = 0; i < count; ++i) {
    const ForecastLimit& limit = forecast.limits[i];
    if (!limit.without.empty() || !limit.name.view().starts_with("horizontal")) continue;
    if (!std::isfinite(limit.time_to_limit_s) || limit.time_to_limit_s <= 0.0) continue;
    if (!next || limit.time_to_limit_s < next->time_to_limit_s) next = limit;
  }
  return next;
}

void raise(Trust& trust, TrustLevel level) {
  trust.level = std::max(trust.level, level);
}

Trust no_navigation(const StatusView& view) {
  Trust out;
  out.level = TrustLevel::bad;
  out.sentence = "No navigation: ";
  out.sentence += view.nav ? "the last state came " + duration_text(view.nav->age_s) + " ago"
                           : std::string("nothing has been heard yet");
  out.advice = "Look at the services: fusion and the inertial sensor's bridge have to be alive.";
  return out;
}

Trust not_yet(const StatusView& view) {
  Trust out;
  out.level = TrustLevel::bad;
  const NavState& nav = view.nav->sample;
  out.sentence = nav.mode == NavMode::aligning ? "No navigation yet: aligning"
                                               : "No navigation yet: waiting for sensors";
  if (view.alignment) {
    const AlignmentStatus& status = view.alignment->sample;
    out.sentence += ", " + std::string(to_string(status.phase)) + " for " + duration_text(status.in_phase_s);
    if (std::isfinite(status.time_to_aligned_s) && status.time_to_aligned_s > 0.0) {
      out.sentence += ", done in " + about(status.time_to_aligned_s);
    }
    out.advice = status.advice.data();
  }
  return out;
}

void judge_gps(const StatusView& view, Trust& trust) {
  const NavState& nav = view.nav->sample;
  if (view.monitor && view.monitor->sample.gps_outage_active) {
    const ReceiverWord why = why_no_gps(view);
    const std::string phrase = why.phrase();
    if (!phrase.empty()) trust.sentence += ", " + phrase;
    const bool has_fix = why.trouble == ReceiverTrouble::refused || why.trouble == ReceiverTrouble::disputed;
    if (!has_fix) trust.sentence += ", GPS gone " + duration_text(view.monitor->sample.gps_outage_s);
    raise(trust, view.monitor->sample.gps_outage_severity == Severity::critical ? TrustLevel::bad
                                                                                : TrustLevel::caution);
    // Then the position may be as far wrong as the fix is away.
    if (why.trouble == ReceiverTrouble::disputed) raise(trust, TrustLevel::bad);
    trust.advice = why.advice();
    if (!trust.advice.empty()) return;
    trust.advice = nav.mode == NavMode::acoustic_aided
                       ? "USBL carries the position; it stays good while its fixes come."
                       : "Surface for GPS or get a USBL fix before the limit is passed.";
  } else if (nav.mode != NavMode::gps_aided) {
    trust.sentence += std::isfinite(nav.gps_outage_s)
                          ? ", GPS last used " + duration_text(nav.gps_outage_s) + " ago"
                          : std::string(", no GPS yet");
  }
}

}  // namespace

std::string_view to_string(TrustLevel level) {
  switch (level) {
    case TrustLevel::good:
      return "good";
    case TrustLevel::caution:
      return "caution";
    case TrustLevel::bad:
      break;
  }
  return "bad";
}

Trust judge_trust(const StatusView& view, double fresh_s) {
  if (!view.nav || view.nav->age_s > fresh_s) return no_navigation(view);
  const NavState& nav = view.nav->sample;
  const bool finite = std::isfinite(nav.latitude_rad) && std::isfinite(nav.longitude_rad);
  if (!gives_position(nav.mode) || !finite) return not_yet(view);

  Trust out;
  out.level = nav.mode == NavMode::inertial ? TrustLevel::caution : TrustLevel::good;
  const bool gps_gone = view.monitor && view.monitor->sample.gps_outage_active;
  out.sentence = basis(nav, gps_gone);
  judge_gps(view, out);
  const double radius_m = horizontal_95_m(nav.position_covariance_N_m2);
  out.sentence += ", 95 % " + metres(radius_m);
  if (!std::isfinite(radius_m)) raise(out, TrustLevel::bad);
  if (nav.mode != NavMode::gps_aided || gps_gone) {
    if (const auto limit = next_limit(view)) {
      out.sentence += ", passes " + metres(limit->limit) + " in " + about(limit->time_to_limit_s);
      if (limit->time_to_limit_s < kSoonS) raise(out, TrustLevel::caution);
    }
  }
  if (nav.alignment != AlignmentPhase::aligned) {
    out.sentence += ", alignment " + std::string(to_string(nav.alignment));
    raise(out, nav.alignment == AlignmentPhase::lost ? TrustLevel::bad : TrustLevel::caution);
    if (view.alignment && view.alignment->sample.advice[0] != '\0')
      out.advice = view.alignment->sample.advice.data();
  }
  if (!view.monitor || view.monitor->age_s > kMonitorFreshS) {
    out.sentence += ", and nobody watches: the monitor is silent";
    raise(out, TrustLevel::caution);
    if (out.advice.empty()) out.advice = "Start the monitor: alarms are not judged without it.";
  } else if (!view.monitor->sample.known) {
    out.sentence += ", and the monitor has just been started and does not know yet";
    raise(out, TrustLevel::caution);
  } else if (!view.monitor->sample.healthy) {
    raise(out, TrustLevel::caution);
    if (out.advice.empty()) out.advice = "See the alarms below.";
  }
  return out;
}

}  // namespace fathom::status

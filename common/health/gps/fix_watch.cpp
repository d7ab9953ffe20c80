#include "health/gps/fix_watch.hpp"

#include <algorithm>
#include <cmath>

#include "geo/wgs84.hpp"
#include "health/gps/gps_outage.hpp"
#include "health/gps/receivers.hpp"
#include "health/navigation/nav_watch.hpp"
#include "health/text.hpp"
#include "samples/position/gives_position.hpp"

namespace fathom::health {
namespace {

constexpr double kLongestStepS = 2.5;  // of a velocity that is integrated, and between fixes of a window
constexpr double kStillM_s = 0.2;      // slower than this is noise, not travel
constexpr double kNavHistoryS = 5.0;
constexpr double kNavHistoryStepS = 0.1;
constexpr std::size_t kMaxWindow = 512;
constexpr int kFewest = 3;
constexpr double kSigmas = 5.0;
constexpr double kClearHoldS = 3.0;

double norm(double north, double east) {
  return std::hypot(north, east);
}

}  // namespace

void FixWatch::advance(Travel& travel, TimeNs stamp_ns, const Pair& velocity_m_s, double speed_m_s) {
  const double step_s = to_seconds(stamp_ns - travel.stamp_ns);
  if (travel.stamp_ns != 0 && step_s > 0.0 && step_s <= kLongestStepS) {
    for (std::size_t i = 0; i < 2; ++i) {
      travel.moved_m[i] += 0.5 * step_s * (travel.velocity_m_s[i] + velocity_m_s[i]);
    }
    if (speed_m_s > kStillM_s) travel.path_m += step_s * speed_m_s;
  }
  travel.stamp_ns = stamp_ns;
  travel.velocity_m_s = velocity_m_s;
}

void FixWatch::add(const NavState& state, const Instant& /*now*/) {
  const auto& v = state.velocity_N_m_s;
  const bool usable = gives_position(state.mode) && std::isfinite(v[0]) && std::isfinite(v[1]);
  if (!usable) {
    nav_.stamp_ns = 0;
    nav_velocity_sigma_m_s_ = kUnknown;
    nav_history_.clear();
    return;
  }
  const auto& p = state.velocity_covariance_N_m2_s2;
  nav_velocity_sigma_m_s_ = std::sqrt(std::max(p[0], p[4]));
  advance(nav_, state.header.stamp_ns, {v[0], v[1]}, norm(v[0], v[1]));
  if (nav_history_.empty() || to_seconds(nav_.stamp_ns - nav_history_.back().stamp_ns) >= kNavHistoryStepS) {
    nav_history_.push_back(nav_);
  }
  while (to_seconds(nav_.stamp_ns - nav_history_.front().stamp_ns) > kNavHistoryS) nav_history_.pop_front();
  if (nav_history_.front().stamp_ns > nav_.stamp_ns) nav_history_.clear();  // time went back
}

void FixWatch::add(const DvlSample& sample, const Instant& /*now*/) {
  const auto& v = sample.velocity_D_m_s;
  const double speed_m_s = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double step_s = to_seconds(sample.header.stamp_ns - dvl_stamp_ns_);
  const bool travels = sample.mode == DvlMode::bottom && speed_m_s > kStillM_s;  // false when unknown
  if (dvl_stamp_ns_ != 0 && step_s > 0.0 && step_s <= kLongestStepS && travels) {
    dvl_path_m_ += step_s * speed_m_s;
  }
  dvl_stamp_ns_ = sample.header.stamp_ns;
}

void FixWatch::add(const Verdict& verdict) {
  if (verdict.source != SourceKind::gps) return;
  const auto found = receivers_.find(verdict.header.sensor);
  if (found == receivers_.end()) return;
  const bool frozen = verdict.kind == VerdictKind::frozen;
  found->second.judged_frozen = frozen ? std::min(found->second.judged_frozen + 1, kFewest) : 0;
}

bool FixWatch::add(const GpsSample& sample, const Instant& now) {
  auto found = receivers_.find(sample.header.sensor);
  if (found == receivers_.end()) {
    if (receivers_.size() >= kMaxReceivers) return true;
    found = receivers_.emplace(sample.header.sensor, Receiver{}).first;
  }
  Receiver& receiver = found->second;
  receiver.heard_ns = now.monotonic_ns;
  if (!is_usable(sample)) {
    receiver.frozen = false;  // it no longer claims anything
    receiver.same = 0;
    receiver.reading.fill(kUnknown);
    receiver.window.clear();
    receiver.disagreeing = 0;
    return true;
  }
  if (receiver.own.stamp_ns == sample.header.stamp_ns) return !receiver.frozen;  // the same message again
  const auto& v = sample.velocity_N_m_s;
  const bool own_known = std::isfinite(v[0]) && std::isfinite(v[1]);
  if (own_known != receiver.own_known) receiver.window.clear();
  receiver.own_known = own_known;
  advance(receiver.own, sample.header.stamp_ns, receiver.own_known ? Pair{v[0], v[1]} : Pair{},
          receiver.own_known ? norm(v[0], v[1]) : 0.0);
  judge_frozen(receiver, sample, now);
  judge_displacement(receiver, sample, now);
  return !receiver.frozen;
}

void FixWatch::judge_frozen(Receiver& receiver, const GpsSample& sample, const Instant& now) const {
  const std::array<double, 3> reading{sample.latitude_rad, sample.longitude_rad, sample.altitude_m};
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  if (!std::equal(reading.begin(), reading.end(), receiver.reading.begin(), same)) {
    receiver.reading = reading;
    receiver.same = 1;
    receiver.same_since_ns = now.monotonic_ns;
    receiver.own_at_reading = receiver.own;
    receiver.nav_path_at_reading_m = nav_.path_m;
    receiver.dvl_path_at_reading_m = dvl_path_m_;
    receiver.judged_frozen = 0;
    receiver.frozen = false;
    return;
  }
  ++receiver.same;
  receiver.travelled_m =
      std::max({receiver.own.path_m - receiver.own_at_reading.path_m,
                nav_.path_m - receiver.nav_path_at_reading_m, dvl_path_m_ - receiver.dvl_path_at_reading_m});
  if (receiver.same < kFewest) return;
  receiver.frozen =
      receiver.frozen || receiver.travelled_m > config_.frozen_path_m || receiver.judged_frozen >= kFewest;
}

std::optional<FixWatch::Pair> FixWatch::nav_moved_at(TimeNs stamp_ns) const {
  // Beyond this velocity error the navigation state has no opinion on a fix.
  constexpr double kWorstSigmaM_s = 0.5;
  if (nav_history_.empty() || !(nav_velocity_sigma_m_s_ < kWorstSigmaM_s)) return std::nullopt;
  if (stamp_ns < nav_history_.front().stamp_ns) return std::nullopt;
  const double newer_s = to_seconds(stamp_ns - nav_.stamp_ns);
  if (newer_s > 0.5) return std::nullopt;
  const auto after = std::find_if(nav_history_.begin(), nav_history_.end(),
                                  [&](const Travel& travel) { return travel.stamp_ns > stamp_ns; });
  const Travel& from = newer_s > 0.0 ? nav_ : *std::prev(after);
  const double step_s = to_seconds(stamp_ns - from.stamp_ns);
  return Pair{from.moved_m[0] + step_s * from.velocity_m_s[0],
              from.moved_m[1] + step_s * from.velocity_m_s[1]};
}

void FixWatch::judge_displacement(Receiver& receiver, const GpsSample& sample, const Instant& now) const {
  auto& window = receiver.window;
  const TimeNs stamp_ns = sample.header.stamp_ns;
  if (!window.empty()) {
    const double step_s = to_seconds(stamp_ns - window.back().stamp_ns);
    if (step_s <= 0.0 || step_s > kLongestStepS) window.clear();
  }
  const auto& sigma = sample.position_sigma_N_m;
  Fix fix{stamp_ns, sample.latitude_rad, sample.longitude_rad, 0.0, std::nullopt, nav_moved_at(stamp_ns)};
  if (receiver.own_known) fix.own_m = receiver.own.moved_m;
  if (std::isfinite(sigma[0]) && std::isfinite(sigma[1])) fix.sigma_m = norm(sigma[0], sigma[1]);
  window.push_back(fix);
  while (to_seconds(stamp_ns - window.front().stamp_ns) > config_.window_s || window.size() > kMaxWindow) {
    window.pop_front();
  }
  // Against the oldest a lasting change shows, against the last one fixes that come from two places by turns.
  const bool apart = compare(receiver, window.front(), fix) ||
                     (window.size() > 1 && compare(receiver, window[window.size() - 2], fix));
  receiver.disagreeing = apart ? receiver.disagreeing + 1 : 0;
  if (receiver.disagreeing >= kFewest) receiver.disagreed_ns = now.monotonic_ns;
}

bool FixWatch::compare(Receiver& receiver, const Fix& from, const Fix& to) const {
  const double span_s = to_seconds(to.stamp_ns - from.stamp_ns);
  const auto moved = geo::difference_N({from.latitude_rad, from.longitude_rad, 0.0},
                                       {to.latitude_rad, to.longitude_rad, 0.0});
  const auto apart_m = [&](const std::optional<Pair>& begin, const std::optional<Pair>& end) {
    if (!begin || !end) return 0.0;
    return norm(moved[0] - ((*end)[0] - (*begin)[0]), moved[1] - ((*end)[1] - (*begin)[1]));
  };
  const auto differs = [&](Against whom, double by_m, double limit_m) {
    if (by_m <= limit_m) return false;
    receiver.against = whom;
    receiver.apart_m = by_m;
    receiver.limit_m = limit_m;
    receiver.span_s = span_s;
    return true;
  };
  const double limit_m = std::max(config_.disagreement_m, kSigmas * norm(from.sigma_m, to.sigma_m));
  if (differs(Against::own, apart_m(from.own_m, to.own_m), limit_m)) return true;
  if (!from.nav_m || !to.nav_m) return false;
  return differs(Against::nav, apart_m(from.nav_m, to.nav_m),
                 limit_m + kSigmas * span_s * nav_velocity_sigma_m_s_);
}

bool FixWatch::frozen(const Name& name) const {
  const auto found = receivers_.find(name);
  return found != receivers_.end() && found->second.frozen;
}

TimeNs FixWatch::same_since_ns(const Name& name) const {
  const auto found = receivers_.find(name);
  return found == receivers_.end() ? 0 : found->second.same_since_ns;
}

void FixWatch::report(AlarmBook& book, const Instant& now) const {
  for (const auto& [name, receiver] : receivers_) {
    const double same_s = to_seconds(now.monotonic_ns - receiver.same_since_ns);
    book.set(receiver.frozen && fresh_.of_sensor(SourceKind::gps, name, receiver.heard_ns, now),
             {.key = alarm_key("gps_frozen", name.view()),
              .severity = Severity::warning,
              .text = sentence("Receiver %s has repeated one fix for %s while the vehicle travelled %.0f m.",
                               name.c_str(), duration_text(same_s).c_str(), receiver.travelled_m),
              .value = receiver.travelled_m,
              .limit = config_.frozen_path_m,
              .began_ago_s = same_s,
              .clear_hold_s = kClearHoldS},
             now);
    const double ago_s = to_seconds(now.monotonic_ns - receiver.disagreed_ns);
    const bool disagrees = receiver.disagreed_ns != 0 && ago_s < kLongestStepS;
    book.set(
        disagrees,
        {.key = alarm_key("gps_disagrees", name.view()),
         .severity = Severity::warning,
         .text = sentence("Fixes of %s moved by %.0f m within %.1f s otherwise than %s says (limit %.0f m).",
                          name.c_str(), receiver.apart_m, receiver.span_s,
                          receiver.against == Against::own ? "its own velocity" : "the navigation state",
                          receiver.limit_m),
         .value = receiver.apart_m,
         .limit = receiver.limit_m,
         .began_ago_s = receiver.span_s,
         .clear_hold_s = kClearHoldS},
        now);
  }
}

}  // namespace fathom::health

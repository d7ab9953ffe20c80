#include "health/gps/dispute_watch.hpp"

#include <cmath>
#include <limits>

#include "health/gps/receivers.hpp"
#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr double kSilent_s = 10.0;  // at least, before it says nothing any more: verdicts come late
constexpr double kDisputeHold_s = 3.0;

bool is_dispute(VerdictKind kind) {
  return kind == VerdictKind::rejected || kind == VerdictKind::disputed;
}

}  // namespace

void DisputeWatch::add(const Verdict& verdict, const Instant& now) {
  if (verdict.source != SourceKind::gps) return;
  auto found = receivers_.find(verdict.header.sensor);
  if (found == receivers_.end()) {
    if (receivers_.size() >= kMaxReceivers) return;
    found = receivers_.emplace(verdict.header.sensor, Receiver{}).first;
  }
  Receiver& receiver = found->second;
  if (!is_dispute(verdict.kind)) {
    if (verdict.kind == VerdictKind::used) receiver = {};
    return;
  }
  if (receiver.refused == 0) receiver.since_ns = now.monotonic_ns;
  if (receiver.refused < std::numeric_limits<int>::max()) ++receiver.refused;
  receiver.last_ns = now.monotonic_ns;
  receiver.disputed = verdict.kind == VerdictKind::disputed;
  receiver.apart_m = std::hypot(verdict.innovation[0], verdict.innovation[1]);
  receiver.sigma_m = std::hypot(verdict.innovation_sigma[0], verdict.innovation_sigma[1]);
}

void DisputeWatch::report(AlarmBook& book, const Instant& now) const {
  for (const auto& [name, receiver] : receivers_) {
    const double for_s = to_seconds(now.monotonic_ns - receiver.since_ns);
    const bool current = fresh_.of_sensor(SourceKind::gps, name, receiver.last_ns, now, kSilent_s);
    book.set(
        receiver.disputed && current,
        {.key = alarm_key("gps_disputed", name.view()),
         .severity = Severity::critical,
         .text = sentence(
             "%s has put the vehicle %.0f m from where navigation does for %s (sigma %.0f m): one "
             "of them is wrong. Fixes stay refused. Disable %s, or set the position.",
             name.c_str(), receiver.apart_m, duration_text(for_s).c_str(), receiver.sigma_m, name.c_str()),
         .value = receiver.apart_m,
         .limit = receiver.sigma_m,
         .began_ago_s = for_s,
         .clear_hold_s = kDisputeHold_s},
        now);
  }
}

}  // namespace fathom::health

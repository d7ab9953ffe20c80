#include "explain/around.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "explain/explain.hpp"
#include "explain/watch/track.hpp"

namespace fathom::explain {
namespace {

constexpr DurationNs kOver_ns = 30 * kNsPerSecond;  // alarms wait for some seconds, and operators look later
constexpr DurationNs kEarly_ns = 3 * kNsPerSecond;  // instants of findings are those of whole seconds
constexpr DurationNs kMinute_ns = 60 * kNsPerSecond;

bool at_the_time(const Finding& one, TimeNs at_ns) {
  return one.begin_ns <= at_ns + kEarly_ns && one.end_ns + kOver_ns >= at_ns;
}

/// What the values of a source tell, and not whether there are any.
bool is_of_values(Kind kind) {
  return kind >= Kind::wrong_heading && kind <= Kind::wrong_lever;
}

/// What an alarm is about: the part behind the colon, or the kind of source that its name begins with.
bool concerns(const std::string& alarm, const Finding& one) {
  const bool absence = alarm.find("_missing") != std::string::npos || alarm.starts_with("service_");
  if (absence && is_of_values(one.kind)) return false;
  const std::size_t colon = alarm.find(':');
  if (colon != std::string::npos) {
    const std::string subject = alarm.substr(colon + 1);
    return subject == one.subject || subject == one.subject + "_bridge" || subject + "_bridge" == one.subject;
  }
  if (alarm.starts_with("alignment"))
    return one.kind == Kind::not_aligned || one.kind == Kind::alignment_lost;
  if (alarm.starts_with("nav_state")) return one.kind == Kind::state_gap;
  return !one.subject.empty() && alarm.starts_with(one.subject + "_");
}

/// When what an alarm tells of began: monitors wait before they raise it, each kind as long as it has to.
TimeNs began_ns(const AlarmRow& row) {
  const TimeNs since_ns = row.alarm.since_ns;
  return since_ns > 0 && since_ns <= row.log_ns ? since_ns : row.log_ns;
}

/// Whether a finding was under way when something began, within the second of a life sign and those after
/// which a missed one is noticed.
bool covers(const Finding& one, TimeNs at_ns) {
  return one.begin_ns <= at_ns + LifeSign::kSilence_ns && one.end_ns + LifeSign::kSilence_ns >= at_ns;
}

}  // namespace

std::uint64_t SourceThen::all() const {
  return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
}

VerdictKind SourceThen::main_reason() const {
  std::size_t best = static_cast<std::size_t>(VerdictKind::used);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (i == static_cast<std::size_t>(VerdictKind::used) || counts[i] == 0) continue;
    if (best == static_cast<std::size_t>(VerdictKind::used) || counts[i] > counts[best]) best = i;
  }
  return static_cast<VerdictKind>(best);
}

Around around(const History& history, TimeNs at_ns) {
  Around out;
  out.at_ns = at_ns;
  const Track track(history);
  out.state = track.at(at_ns);
  out.earlier = track.at(at_ns - kMinute_ns);
  if (out.earlier == nullptr && !track.rows().empty() && track.rows().front()->at_ns < at_ns)
    out.earlier = track.rows().front();
  for (const Stream& stream : history.streams()) {
    SourceThen& one = out.sources.emplace_back();
    one.sensor = stream.sensor.str();
    one.kind = stream.kind;
    for (const Second& second : stream.seconds)
      if (second.at_ns <= at_ns) one.last_heard_s = to_seconds(at_ns - second.at_ns);
  }
  for (const VerdictRow& row : history.verdicts()) {
    if (row.stamp_ns > at_ns) continue;
    SourceThen& one = out.sources[row.stream];
    const double before_s = to_seconds(at_ns - row.stamp_ns);
    if (row.kind == VerdictKind::used && !(one.last_used_s < before_s)) one.last_used_s = before_s;
    if (at_ns - row.stamp_ns > Around::kWindow_ns) continue;
    ++one.counts[static_cast<std::size_t>(row.kind)];
    if (!is_refusal(row.kind)) continue;
    for (std::size_t i = 0; i < row.dimensions; ++i) {
      const double sigmas = std::abs(row.innovation[i] / row.sigma[i]);
      if (std::isfinite(sigmas) && !(one.worst_sigmas > sigmas)) one.worst_sigmas = sigmas;
    }
  }
  return out;
}

std::vector<std::size_t> under_way(const Findings& all, TimeNs at_ns) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (at_the_time(all[i], at_ns)) out.push_back(i);
  return out;
}

std::optional<std::size_t> behind(const Findings& all, const AlarmRow& alarm) {
  const TimeNs at_ns = began_ns(alarm);
  const std::string name = alarm.alarm.alarm.str();
  // What concerns it before what touches everything; of those what began last.
  for (const bool own : {true, false}) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!covers(all[i], at_ns)) continue;
      if (own ? !concerns(name, all[i]) : all[i].follows_from || !named(all[i]) || !touches_all(all[i]))
        continue;
      if (!best || began_nearer(all[i], all[*best], at_ns)) best = i;
    }
    if (best) return all[*best].follows_from.value_or(*best);
  }
  return std::nullopt;
}

}  // namespace fathom::explain

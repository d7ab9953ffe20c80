#include <algorithm>

#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

// An alignment at rest takes its averaging time and some seconds; one that is still under way after this
// keeps the vehicle waiting. The monitor's own limit is three times as long.
constexpr double kPatience_s = 60.0;

std::string unmet_of(const AlignmentRow& row) {
  std::string out;
  for (const AlignmentCondition& one : row.unmet) out += (out.empty() ? "" : ", ") + one.name.str();
  return out;
}

/// What was said of the alignment at an instant.
const AlignmentRow* said_at(const History& history, TimeNs at_ns) {
  const AlignmentRow* out = nullptr;
  for (const AlignmentRow& row : history.alignment())
    if (row.log_ns <= at_ns || out == nullptr) out = &row;
  return out;
}

/// What was said last, as evidence.
void add_said(const History& history, TimeNs at_ns, Finding& found) {
  const AlignmentRow* said = said_at(history, at_ns);
  if (said == nullptr) return;
  const std::string unmet = unmet_of(*said);
  found.evidence.push_back(
      {"fathom/v1/alignment", 1,
       "phase " + std::string(to_string(said->phase)) + (unmet.empty() ? "" : "; not met: " + unmet)});
  if (!said->advice.empty()) found.evidence.push_back({"fathom/v1/alignment", 1, said->advice});
}

/// Inertial samples, and not one navigation state.
void silent(const History& history, Findings& out) {
  const bool any = std::any_of(history.streams().begin(), history.streams().end(), [](const Stream& one) {
    return one.kind == SourceKind::imu && one.samples > 0;
  });
  const double for_s = to_seconds(history.to_ns() - history.from_ns());
  if (!any || for_s < kPatience_s) return;
  Finding found{.kind = Kind::not_aligned,
                .weight = Weight::bad,
                .subject = "fusion",
                .begin_ns = history.from_ns(),
                .end_ns = history.to_ns(),
                .word = "no_state",
                .figures = {{"for_s", for_s}},
                .evidence = {{"fathom/v1/nav_state", 0, "no states"}}};
  add_said(history, history.to_ns(), found);
  out.push_back(std::move(found));
}

}  // namespace

void watch_alignment(const History& history, Findings& out) {
  const auto& states = history.states();
  if (states.empty()) {
    silent(history, out);
    return;
  }
  const auto find = [&](auto from, auto&& what) {
    return std::find_if(from, states.end(), [&](const StateRow& row) { return what(row.alignment); });
  };
  const auto is_aligned = [](AlignmentPhase phase) { return phase == AlignmentPhase::aligned; };
  const auto not_so = [](AlignmentPhase phase) { return phase != AlignmentPhase::aligned; };
  bool ever = false;
  for (auto from = find(states.begin(), not_so); from != states.end();) {
    ever = ever || from != states.begin();
    const auto to = find(from, is_aligned);
    const TimeNs end_ns = to == states.end() ? states.back().log_ns : to->log_ns;
    const double for_s = to_seconds(end_ns - from->log_ns);
    if (ever || for_s > kPatience_s) {
      std::uint64_t waiting = 0;
      for (const VerdictRow& row : history.verdicts())
        waiting += row.kind == VerdictKind::not_aligned && row.log_ns >= from->log_ns && row.log_ns <= end_ns;
      Finding found{.kind = ever ? Kind::alignment_lost : Kind::not_aligned,
                    .weight = to == states.end() || ever ? Weight::bad : Weight::caution,
                    .subject = history.name(from->instance),
                    .begin_ns = from->log_ns,
                    .end_ns = end_ns,
                    .word = ever                 ? "lost"
                            : to == states.end() ? "never"
                                                 : "slow",
                    .figures = {{"for_s", for_s}, {"waiting", static_cast<double>(waiting)}}};
      add_said(history, end_ns - kNsPerSecond, found);
      if (waiting > 0) found.evidence.push_back({"fathom/v1/verdict", waiting, "not_aligned"});
      out.push_back(std::move(found));
    }
    if (to == states.end()) break;
    ever = true;
    from = find(to, not_so);
  }
}

}  // namespace fathom::explain

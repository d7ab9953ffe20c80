#include <algorithm>
#include <cmath>

#include "explain/watch/silence.hpp"
#include "explain/watch/watches.hpp"

namespace fathom::explain {
namespace {

constexpr double kSilence_s = 1.0;  // as the monitor's nav_state_missing
// Twice as uncertain, and by as much as a good fix is.
constexpr double kTimes = 2.0;
constexpr double kLeastStep_m = 1.0;

void gaps(const History& history, Findings& out) {
  const auto say = [&](const StateRow& before, TimeNs end_ns, bool to_end) {
    out.push_back({.kind = Kind::state_gap,
                   .weight = Weight::bad,
                   .subject = history.name(before.instance),
                   .begin_ns = before.log_ns,
                   .end_ns = end_ns,
                   .figures = {{"for_s", to_seconds(end_ns - before.log_ns)}, {"to_end", to_end ? 1.0 : 0.0}},
                   .evidence = {{"fathom/v1/nav_state", 0, "no states in this time"}}});
  };
  const StateRow* last = nullptr;
  for (const StateRow& row : history.states()) {
    const StateRow* before = std::exchange(last, &row);
    if (before == nullptr) continue;
    if (to_seconds(row.log_ns - before->log_ns) >= kSilence_s) say(*before, row.log_ns, false);
  }
  // Up to the end: of a fusion that was not told to stop.
  if (last != nullptr && history.to_ns() - last->log_ns > LifeSign::kSilence_ns &&
      goes_on(history, history.name(last->instance)))
    say(*last, history.to_ns(), true);
}

void resets(const History& history, const Track& track, Findings& out) {
  const StateRow* last = nullptr;
  for (const StateRow* row : track.rows()) {
    const StateRow* before = std::exchange(last, row);
    if (before == nullptr || row->resets <= before->resets || before->writer != row->writer) continue;
    // The first position is none that stepped.
    if (!navigating(*before) || !(row->reset_m > 0.0)) continue;
    // Within what navigation said of itself before it is put right, and nobody was misled.
    const bool told = row->reset_m <= 3.0 * before->sigma_m;
    out.push_back({.kind = Kind::reset,
                   .weight = told ? Weight::note : Weight::caution,
                   .subject = history.name(row->instance),
                   .begin_ns = row->at_ns,
                   .end_ns = row->at_ns,
                   .figures = {{"step_m", row->reset_m}, {"sigma_before_m", before->sigma_m}},
                   .evidence = {{"fathom/v1/nav_state", 1, "reset_counter"}}});
  }
}

/// Sources that had been used before and gave nothing in a stretch.
std::string missing_in(const History& history, TimeNs from_ns, TimeNs to_ns) {
  std::string out;
  for (std::size_t i = 0; i < history.streams().size(); ++i) {
    const Stream& stream = history.streams()[i];
    std::uint64_t before = 0;
    std::uint64_t within = 0;
    for (const VerdictRow& row : history.verdicts()) {
      if (row.stream != i || row.kind != VerdictKind::used) continue;
      before += row.stamp_ns <= from_ns ? 1U : 0U;
      within += row.stamp_ns > from_ns + kNsPerSecond && row.stamp_ns < to_ns - kNsPerSecond ? 1U : 0U;
    }
    if (before > 3 && within == 0) out += (out.empty() ? "" : ", ") + stream.sensor.str();
  }
  return out;
}

void growth(const History& history, const Track& track, Findings& out) {
  const StateRow* low = nullptr;
  const StateRow* high = nullptr;
  const auto close = [&] {
    if (low != nullptr && high != nullptr && high->sigma_m > kTimes * low->sigma_m &&
        high->sigma_m - low->sigma_m > kLeastStep_m) {
      out.push_back({.kind = Kind::growth,
                     .weight = Weight::note,
                     .begin_ns = low->at_ns,
                     .end_ns = high->at_ns,
                     .word = missing_in(history, low->at_ns, high->at_ns),
                     .figures = {{"sigma_before_m", low->sigma_m},
                                 {"sigma_after_m", high->sigma_m},
                                 {"for_s", to_seconds(high->at_ns - low->at_ns)}},
                     .evidence = {{"fathom/v1/nav_state", 0, "position_covariance_N_m2"}}});
    }
    low = high = nullptr;
  };
  for (const StateRow* row : track.rows()) {
    if (!navigating(*row) || !std::isfinite(row->sigma_m)) continue;
    if (low == nullptr || row->sigma_m < low->sigma_m) {
      if (high == nullptr) {
        low = row;
        continue;
      }
    }
    if (high == nullptr || row->sigma_m > high->sigma_m) high = row;
    // A rise is over when most of it is gone.
    if (row->sigma_m < low->sigma_m + 0.3 * (high->sigma_m - low->sigma_m)) {
      close();
      low = row;
    }
  }
  close();
}

}  // namespace

void watch_states(const History& history, const Track& track, Findings& out) {
  gaps(history, out);
  resets(history, track, out);
  growth(history, track, out);
}

}  // namespace fathom::explain

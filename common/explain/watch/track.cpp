#include "explain/watch/track.hpp"

#include <algorithm>
#include <cmath>

#include "samples/position/gives_position.hpp"

namespace fathom::explain {
namespace {

constexpr DurationNs kFresh_ns = 2 * kNsPerSecond;

double speed_m_s(const StateRow& row) {
  const double speed = std::hypot(row.velocity_N_m_s[0], row.velocity_N_m_s[1]);
  return navigating(row) && std::isfinite(speed) ? speed : 0.0;
}

}  // namespace

bool navigating(const StateRow& row) {
  return gives_position(row.mode);
}

Track::Track(const History& history) {
  for (const StateRow& row : history.states()) rows_.push_back(&row);
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const StateRow* a, const StateRow* b) { return a->at_ns < b->at_ns; });
  path_m_.assign(rows_.size(), 0.0);
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    const double step_s = to_seconds(rows_[i]->at_ns - rows_[i - 1]->at_ns);
    // Over a silence the speed before it holds.
    path_m_[i] = path_m_[i - 1] + speed_m_s(*rows_[i - 1]) * step_s;
  }
}

const StateRow* Track::at(TimeNs stamp_ns) const {
  const auto behind = std::upper_bound(rows_.begin(), rows_.end(), stamp_ns,
                                       [](TimeNs t, const StateRow* row) { return t < row->at_ns; });
  if (behind == rows_.begin()) return nullptr;
  const StateRow* row = *std::prev(behind);
  return stamp_ns - row->at_ns <= kFresh_ns ? row : nullptr;
}

double Track::path_to_m(TimeNs stamp_ns) const {
  const auto behind = std::upper_bound(rows_.begin(), rows_.end(), stamp_ns,
                                       [](TimeNs t, const StateRow* row) { return t < row->at_ns; });
  if (behind == rows_.begin()) return 0.0;
  const auto i = static_cast<std::size_t>(std::distance(rows_.begin(), behind)) - 1;
  return path_m_[i] + speed_m_s(*rows_[i]) * std::min(2.0, to_seconds(stamp_ns - rows_[i]->at_ns));
}

double Track::path_m(TimeNs from_ns, TimeNs to_ns) const {
  return std::max(0.0, path_to_m(to_ns) - path_to_m(from_ns));
}

Judged judged(const History& history, std::size_t stream) {
  Judged out;
  for (const VerdictRow& row : history.verdicts())
    if (row.stream == stream) out.push_back(&row);
  std::stable_sort(out.begin(), out.end(),
                   [](const VerdictRow* a, const VerdictRow* b) { return a->stamp_ns < b->stamp_ns; });
  return out;
}

}  // namespace fathom::explain

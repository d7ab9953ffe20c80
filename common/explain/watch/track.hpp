#pragma once

#include <cstddef>
#include <vector>

#include "explain/history.hpp"

namespace fathom::explain {

/// The navigation states of a history, by their stamps.
class Track {
 public:
  explicit Track(const History& history);

  /// The last one at or before an instant; null before the first, and where that is older than two seconds.
  [[nodiscard]] const StateRow* at(TimeNs stamp_ns) const;
  /// Length of the way between two instants, by the horizontal velocity of navigation.
  [[nodiscard]] double path_m(TimeNs from_ns, TimeNs to_ns) const;
  [[nodiscard]] const std::vector<const StateRow*>& rows() const { return rows_; }

 private:
  [[nodiscard]] double path_to_m(TimeNs stamp_ns) const;
  std::vector<const StateRow*> rows_;
  std::vector<double> path_m_;  // from the first row
};

/// Position and velocity mean something.
[[nodiscard]] bool navigating(const StateRow& row);

/// The verdicts on one stream, by their stamps.
using Judged = std::vector<const VerdictRow*>;
[[nodiscard]] Judged judged(const History& history, std::size_t stream);

/// Whether the measurement was held against navigation and thought wrong.
[[nodiscard]] inline bool is_refusal(VerdictKind kind) {
  return kind == VerdictKind::rejected || kind == VerdictKind::disputed;
}

}  // namespace fathom::explain

#pragma once

#include <string>
#include <vector>

#include "explain/finding.hpp"
#include "explain/history.hpp"

namespace fathom::explain {

/// What is to be found in a history: causes first, by weight and then in the order in which causes come
/// before effects; what follows from another one behind them, naming it.
[[nodiscard]] Findings findings(const History& history);

/// Whether anybody need look: a caution or worse.
[[nodiscard]] inline bool named(const Finding& finding) {
  return finding.weight != Weight::note && !finding.follows_from;
}

/// Whether it touches every source and navigation, whatever it is about itself.
[[nodiscard]] bool touches_all(const Finding& finding);

}  // namespace fathom::explain

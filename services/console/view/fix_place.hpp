#pragma once

#include <optional>

#include "console/view/history.hpp"
#include "samples/gps.hpp"
#include "samples/position/fix.hpp"
#include "samples/usbl.hpp"

namespace fathom::console {

// Where a fix lies on the map; nothing when the sample has no position, or one that needs more than the
// sample itself (an inverted USBL, which measures from the vehicle). For display: flat earth around the
// station.
[[nodiscard]] std::optional<FixRow> place_of(const GpsSample& sample);
[[nodiscard]] std::optional<FixRow> place_of(const UsblSample& sample);
[[nodiscard]] std::optional<FixRow> place_of(const FixSample& sample);

}  // namespace fathom::console

#pragma once

#include <string>

#include "console/view/vehicle_view.hpp"

namespace fathom::console {

/// One line of JSON: everything now (`status` is the line of `fathom status --json`) and the rows that are
/// new. Unknown numbers are null, instants are milliseconds since the Unix epoch, UTC.
[[nodiscard]] std::string tick_json(const Tick& tick);

/// One line of JSON: the history up to and including tick number `tick`.
[[nodiscard]] std::string snapshot_json(const Snapshot& snapshot);

}  // namespace fathom::console

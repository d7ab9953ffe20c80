#pragma once

#include "codec/framer.hpp"

namespace fathom::codec {

/// JSON objects one after the other in a stream of bytes, on one line each or spread over several. An object
/// ends at the brace that closes it; one that is cut short ends where the next one opens a line.
[[nodiscard]] Probe probe_json_object(Bytes front);

}  // namespace fathom::codec

#pragma once

#include <string>

#include "samples/position/fix.hpp"

namespace fathom::sim::encode {

/// $PFTHX of the instant in its header, to a millisecond and 1e-8 degrees.
[[nodiscard]] std::string fix_text(const FixSample& sample);

}  // namespace fathom::sim::encode

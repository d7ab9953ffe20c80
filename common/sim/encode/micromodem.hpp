#pragma once

#include <string>

#include "samples/range.hpp"

namespace fathom::sim::encode {

/// CAMPR, the answer of the beacon to the ping of modem 1, to 0.1 ms.
[[nodiscard]] std::string micromodem(const RangeSample& sample);

}  // namespace fathom::sim::encode

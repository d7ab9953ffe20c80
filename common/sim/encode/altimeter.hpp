#pragma once

#include <string>

#include "samples/altimeter.hpp"

namespace fathom::sim::encode {

/// DPT, to the centimetre; unknown altitude is an empty field, unknown offset 0.
[[nodiscard]] std::string nmea_dpt(const AltimeterSample& sample);

}  // namespace fathom::sim::encode

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "samples/altimeter.hpp"

namespace fathom::sim::encode {

/// DPT, to the centimetre; unknown altitude is an empty field, unknown offset 0.
[[nodiscard]] std::string nmea_dpt(const AltimeterSample& sample);

/// A number a line, metres to the millimetre, as Tritech sends it; unknown altitude is 0.
[[nodiscard]] std::string ascii_altitude(const AltimeterSample& sample);

/// Profile (1300) of the Ping protocol, to the millimetre, with 200 strengths; unknown altitude is a range of
/// 0 of which the device is not sure at all.
[[nodiscard]] std::vector<std::uint8_t> ping_profile(const AltimeterSample& sample, std::uint32_t number);

}  // namespace fathom::sim::encode

#pragma once

#include <string>

#include "codec/registry.hpp"
#include "samples/airspeed.hpp"

namespace fathom::sim::encode {

/// The configured columns, checksum, CR LF, as the ascii_air_data codec with the same options reads them.
/// Pressures follow from the speeds and the barometric altitude, the temperature is that at which the
/// indicated airspeed is the true one, without a true one that of the standard atmosphere. What is unknown is
/// blank.
[[nodiscard]] std::string ascii_air_data(const AirspeedSample& sample, const codec::CodecOptions& options);

/// XDR with impact and static pressure in Pa and static temperature in degC, as a pitot tube's transducers
/// send.
[[nodiscard]] std::string nmea_air_data(const AirspeedSample& sample, const codec::CodecOptions& options);

}  // namespace fathom::sim::encode

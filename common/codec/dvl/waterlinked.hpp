#pragma once

#include <memory>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Water Linked A50 and A125: JSON objects over TCP, `json_v1` to `json_v3.x`, one per line with LF or CR LF;
/// objects spread over several lines or without a separator are understood too. An object that is cut short
/// ends where the next one opens a line. Unknown types and keys are ignored.
///
/// `velocity` gives a DvlSample of mode bottom, `velocity_water` one of mode water, both in
/// forward-right-down. `velocity_valid` alone decides: without it velocity and beams are unknown, whatever
/// the single beams claim. sigma_m_s is the root of the covariance's mean diagonal, else `fom`. Altitude -1
/// is unknown. The recorded beam velocity already is the vehicle's velocity along the outward beam direction;
/// beams 0 to 3 look 22.5 degrees off down towards 135, -135, -45 and 45 degrees from forward.
/// beam_range_m is the slant distance.
///
/// Time: `time_of_validity` as free-running calendar clock (it shows the wrong year until the instrument has
/// found a time server), and the age at transmission.
[[nodiscard]] std::unique_ptr<Codec> make_waterlinked(const CodecOptions& options);

}  // namespace fathom::codec

#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// Ranges as a WHOI Micro-Modem tells them in sentences like those of NMEA 0183, with one-way travel times:
/// `$CAMPR,SRC,DEST,t` the answer of modem SRC to a ping, `$SNTTA,tA,tB,tC,tD,hhmmss.ss` four transponders,
/// called A to D; an empty one did not answer. The time is turned into a range by the configured speed of
/// sound, and the place of the beacon comes from the configured list. A range is valid when the beacon
/// answered, which is the travel time ago. Other sentences of the modem carry no range.
[[nodiscard]] std::unique_ptr<Codec> make_micromodem(const CodecOptions& options);

}  // namespace fathom::codec

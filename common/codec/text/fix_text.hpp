#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// Positions that somebody tells, one a line, framed as NMEA 0183 is, so that a shell, a modem's script or a
/// ship's computer can write one:
///   $PFTHX,2026-01-31T12:00:00Z,36.4009,127.4000,20[,depth[,depth sigma]][*hh]
/// The instant at which the vehicle was there, UTC, empty for now; latitude and longitude in degrees, north
/// and east positive; sigma of north and of east in m; where known the depth below the surface and its sigma
/// in m. Without a checksum the line end ends it. Other sentences are ignored.
[[nodiscard]] std::unique_ptr<Codec> make_fix_text(const CodecOptions& options);

}  // namespace fathom::codec

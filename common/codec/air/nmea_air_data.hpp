#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// Air data in NMEA 0183 sentences, any talker:
///
/// - XDR: quadruples type, value, unit, name. The name says which quantity (AirDataOptions::transducer); type
///   and unit have to be of it: speed S (or G) with K km/h, M m/s, N knots, S mph; pressure P with B bar,
///   P Pa, H hPa, I inHg, M mmHg; temperature C with C, F or K; altitude D with M or F. S and the
///   units H, I, M, F, K, S are instruments' own (Vaisala WXT530 User's Guide, transducer table); the others
///   are the standard's. Other names are skipped.
/// - POV, of the OpenVario protocol: P static and R total pressure hPa, Q impact pressure Pa, S true airspeed
///   km/h, T static temperature degC. Its other types are skipped.
/// - MWV with reference R and status A, VWR: the wind that a sensor on the vehicle feels is its true
///   airspeed.
///
/// What comes in sentences of its own is joined (AirMemory). Other sentences are good frames without sample.
[[nodiscard]] std::unique_ptr<Codec> make_nmea_air_data(const CodecOptions& options);

}  // namespace fathom::codec

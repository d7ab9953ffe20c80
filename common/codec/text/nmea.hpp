#pragma once

#include <memory>
#include <string_view>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// The sentences that give samples.
extern const std::string_view kNmeaDescription;

/// NMEA 0183, any talker, one codec for all instruments. What a sentence gives stands where it is parsed, in
/// the folder of its kind. Other sentences are good frames without sample.
[[nodiscard]] std::unique_ptr<Codec> make_nmea0183(const CodecOptions& options);

/// The same stream, of which only PSIMSSB gives samples. GGA, HDT and THS are those of the ship and go into
/// its relative fixes.
[[nodiscard]] std::unique_ptr<Codec> make_psimssb(const CodecOptions& options);

/// The same stream, of which only PSONLLD gives samples.
[[nodiscard]] std::unique_ptr<Codec> make_psonlld(const CodecOptions& options);

}  // namespace fathom::codec

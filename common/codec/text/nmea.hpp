#pragma once

#include <memory>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// NMEA 0183, any talker, one codec for all instruments: GGA, GNS, RMC, VTG, GST, ZDA to GpsSample; HDT, HDM,
/// HDG, THS to HeadingSample; RPM to PropulsionSample; RSA and XDR to FinsSample; PSIMSSB to UsblSample.
/// Other sentences are good frames without sample; DPT and DBT among them, which are ranges to the bottom.
[[nodiscard]] std::unique_ptr<Codec> make_nmea0183(const CodecOptions& options);

/// The same stream, of which only PSIMSSB gives samples. GGA, HDT and THS are those of the ship and go into
/// its relative fixes.
[[nodiscard]] std::unique_ptr<Codec> make_psimssb(const CodecOptions& options);

}  // namespace fathom::codec

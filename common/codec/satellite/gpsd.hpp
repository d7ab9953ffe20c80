#pragma once

#include <memory>
#include <string_view>

#include "codec/registry.hpp"

namespace fathom::codec {

/// What a client tells gpsd on connecting; without it gpsd says nothing but its version.
inline constexpr std::string_view kGpsdGreeting = "?WATCH={\"enable\":true,\"json\":true};\n";

/// gpsd, the daemon that shares receivers: its JSON protocol over TCP, port 2947, API 3.x. Each TPV of a new
/// instant gives a sample; satellites and HDOP come from the last SKY. Of several receivers behind one gpsd
/// the first that is heard counts: the others are ignored.
///
/// Altitudes `altHAE` and `altMSL` are taken, the older `alt` means either and is not. Velocity is from
/// `track` and `speed`, or `velN` and `velE` where there are; down from `climb`. Uncertainties: `epx`, `epy`,
/// `epv`, `eps`, `epc`; gpsd calls their certainty unknown (95 % where it made them of DOPs, one sigma where
/// the receiver gave them), so that they are taken as one sigma, which is never too little; of `eps` and
/// `epc` only what is below 5 m/s. A GST of the same receiver is of one sigma by definition and goes before
/// them for a second.
///
/// Time: UTC as gpsd says it.
[[nodiscard]] std::unique_ptr<Codec> make_gpsd(const CodecOptions& options);

}  // namespace fathom::codec

#pragma once

#include <cstdint>
#include <memory>

#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

inline constexpr std::uint8_t kUbxSync1 = 0xB5;
inline constexpr std::uint8_t kUbxSync2 = 0x62;
/// Longest payload believed; raw measurements of a hundred satellites stay below.
inline constexpr std::size_t kUbxMaxPayload = 4096;

/// u-blox UBX, fletcher8 over class, id, length and payload: NAV-PVT (92 bytes, 84 on generation 7) to
/// GpsSample, NAV-RELPOSNED of a moving base to HeadingSample
/// (ubx_heading.hpp); other messages are good frames without sample. What the receiver says of jamming and
/// spoofing (ubx_interference.hpp) goes into the fixes that follow. NMEA and RTCM between them are skipped.
///
/// Position and velocity are unknown unless the receiver declares the fix within its limits (gnssFixOK) and
/// the position valid. hAcc is a radius: one axis has hAcc / sqrt(2). UTC is given only when fully resolved.
[[nodiscard]] std::unique_ptr<Codec> make_ubx(const CodecOptions& options);

}  // namespace fathom::codec

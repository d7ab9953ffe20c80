#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "codec/codec.hpp"
#include "codec/registry.hpp"

namespace fathom::codec {

/// NovAtel OEM6 and OEM7, and receivers that speak the same: binary logs (OEM7 Commands and Logs Reference
/// Manual, sections Binary and 32-bit CRC). BESTPOS (42) and BESTVEL (99) of one time make one GpsSample
/// (FixEpochs); HEADING2 (1335) and DUALANTENNAHEADING (2042) are headings; TIME (101) tells the leap
/// seconds. Other logs, those with a short header and answers to commands are good frames without sample.
/// ASCII logs, NMEA and RTCM between them are skipped.
///
/// Antenna: logs of the secondary antenna (measurement source 1) are ignored. Any other source counts as the
/// primary: older receivers and those of other makers have a 2 there, as in the manual's own example.
///
/// Time: week and time of the week from the header, as UTC where the time status says that they are known to
/// 10 ms or better (novatel::is_known; FINESTEERING is to a microsecond). The leap seconds are those of the
/// last TIME that vouches for its UTC, before that those of gps_time.hpp.
///
/// Fix: none unless the status is SOL_COMPUTED. BESTPOS has a sigma by axis, BESTVEL none. Solutions with
/// corrections, by PPP and by satellite services are differential, a position that somebody has set or a
/// filter carries on is dead reckoning. One that the receiver's own inertial unit has smoothed (INS_*) counts
/// as what corrected it last. A datum other than WGS84 is refused.
///
/// Velocity: BESTVEL is valid `latency` seconds before its time: 0 to 0.15 s by Doppler shifts, half the time
/// between two positions where it was made of them. It is taken for the fix of its time up to 0.15 s and is
/// unknown beyond, as that of an RTK solution at the default 2 Hz, 0.25 s. Logged at 5 Hz or more, or after
/// BESTVELTYPE DOPPLER, it is known.
///
/// Heading: of the line from the primary (master) antenna to the secondary (rover), degrees of true north.
/// It is unknown without an integer solution: a float one on a short line may be wrong by many degrees. One
/// of a line of more than 500 m is that to another vehicle, and no sample. Both logs of one time are one
/// heading. Pitch is checked and not used.
[[nodiscard]] std::unique_ptr<Codec> make_novatel(const CodecOptions& options);

namespace novatel {

inline constexpr std::uint8_t kSync1 = 0xAA;
inline constexpr std::uint8_t kSync2 = 0x44;
inline constexpr std::uint8_t kSync3 = 0x12;
inline constexpr std::uint8_t kShortSync3 = 0x13;
inline constexpr std::size_t kHeader = 28;  ///< or more: it says its own length
inline constexpr std::size_t kShortHeader = 12;
inline constexpr std::size_t kCrc = 4;
/// Longest log believed, all in all; ranges of 300 signals stay below.
inline constexpr std::size_t kMostFrame = 16'384;

/// CRC-32 (polynomial 0xEDB88320, reflected, initially 0, not inverted), sent low byte first, over header and
/// message.
[[nodiscard]] std::uint32_t crc32(std::span<const std::uint8_t> bytes);

}  // namespace novatel
}  // namespace fathom::codec

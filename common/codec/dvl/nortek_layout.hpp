#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>

/// Positions inside the records of Nortek's DVLs, shared by decoder and encoder. Little-endian.
namespace fathom::codec::nortek {

inline constexpr std::uint8_t kSync = 0xA5;
inline constexpr std::uint8_t kFamily = 0x10;  ///< AD2CP: the DVLs, and the Signature profilers
inline constexpr std::uint8_t kBottomTrack = 0x1B;
inline constexpr std::uint8_t kWaterTrack = 0x1D;

namespace header {
inline constexpr std::size_t kLength = 1;  ///< of the header itself
inline constexpr std::size_t kRecord = 2;
inline constexpr std::size_t kFamilyAt = 3;
inline constexpr std::size_t kDataSize = 4;
inline constexpr std::size_t kShort = 10;       ///< its data size has two bytes
inline constexpr std::size_t kLong = 12;        ///< four bytes
inline constexpr std::size_t kDataSumBack = 4;  ///< checksum of the data, so far before the header's end
inline constexpr std::size_t kSumBack = 2;      ///< checksum of the header before it
}  // namespace header

/// Offsets from the first byte behind the header.
namespace record {
inline constexpr std::size_t kVersion = 0;
inline constexpr std::size_t kOffsetOfData = 1;
inline constexpr std::size_t kSerialNumber = 2;
inline constexpr std::size_t kYear = 6;  ///< since 1900; then month from 0, day, hour, minute, second
inline constexpr std::size_t kHundredMicroseconds = 12;
inline constexpr std::size_t kBeams = 14;
inline constexpr std::size_t kStatus = 20;
inline constexpr std::size_t kSoundSpeed = 24;
inline constexpr std::size_t kTemperature = 28;  ///< degrees Celsius
inline constexpr std::size_t kPressure = 32;     ///< bar
inline constexpr std::size_t kData = 36;         ///< where the data begin in version 1
inline constexpr std::uint8_t kKnownVersion = 1;
}  // namespace record

/// Offsets from the first byte of the data: groups of four single-precision numbers, first of beams 1 to 4,
/// then of X, Y, Z1 and Z2.
namespace group {
inline constexpr std::size_t kBeamVelocity = 0;
inline constexpr std::size_t kBeamDistance = 16;  ///< vertical
inline constexpr std::size_t kBeamFigure = 32;
inline constexpr std::size_t kBeamSinceTrigger = 48;
inline constexpr std::size_t kBeamBeforeOutput = 64;
inline constexpr std::size_t kAxisVelocity = 96;
inline constexpr std::size_t kAxisFigure = 112;
inline constexpr std::size_t kAxisSinceTrigger = 128;
inline constexpr std::size_t kAxisBeforeOutput = 144;
inline constexpr std::size_t kAll = 176;
}  // namespace group

/// The lowest of the four bits of the status that say which numbers of a group are valid.
namespace valid {
inline constexpr unsigned kBeamVelocity = 0;
inline constexpr unsigned kBeamDistance = 4;
inline constexpr unsigned kBeamFigure = 8;
inline constexpr unsigned kAxisVelocity = 12;
inline constexpr unsigned kAxisFigure = 16;
}  // namespace valid

/// What stands where a number is not valid.
inline constexpr float kNoVelocity = -32.768F;
inline constexpr float kNoDistance = 0.0F;
inline constexpr float kNoFigure = 10.0F;

/// Z1 - Z2 times this has the noise of a horizontal component: the error velocity as PD0 has it. The
/// cotangent of the nominal beam angle of 25 degrees, over the root of 2.
inline constexpr double kErrorPerDifference = 2.144506920509559 / std::numbers::sqrt2;

}  // namespace fathom::codec::nortek

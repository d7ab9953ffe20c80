#pragma once

#include <cstddef>
#include <cstdint>

/// Positions inside a PD0 ensemble, shared by decoder and encoder. Field offsets count from the first byte of
/// their data type's identifier.
namespace fathom::codec::pd0 {

inline constexpr std::uint8_t kSync = 0x7F;
inline constexpr std::uint8_t kWavePacket = 0x79;
inline constexpr std::size_t kHeaderBytes = 6;    ///< before the offset table
inline constexpr std::size_t kChecksumBytes = 2;  ///< not counted by the header's length
inline constexpr std::int16_t kBadVelocity = -32768;
inline constexpr std::int32_t kBadHighResolution = -2147483647 - 1;

namespace id {
inline constexpr std::uint16_t kFixedLeader = 0x0000;
inline constexpr std::uint16_t kVariableLeader = 0x0080;
inline constexpr std::uint16_t kBottomTrack = 0x0600;
inline constexpr std::uint16_t kNavigation = 0x2013;
inline constexpr std::uint16_t kHighResolution = 0x5803;
inline constexpr std::uint16_t kRange = 0x5804;
}  // namespace id

namespace fixed {
inline constexpr std::size_t kSystemConfiguration = 4;
inline constexpr std::size_t kBeams = 8;
inline constexpr std::size_t kCoordinates = 25;
inline constexpr std::size_t kHeadingAlignment = 26;
inline constexpr std::size_t kShortest = 30;
inline constexpr std::size_t kBeamAngle = 58;  ///< newer firmware only
inline constexpr std::size_t kFull = 59;
inline constexpr std::uint16_t kConvex = 1U << 3;
inline constexpr std::uint16_t kUpward = 1U << 7;
inline constexpr unsigned kAngleShift = 8;  ///< two bits: 15, 20, 30 degrees, other
inline constexpr unsigned kFrameShift =
    3;  ///< two bits of the coordinate byte: beam, instrument, ship, earth
inline constexpr std::uint8_t kTiltsUsed = 1U << 2;
}  // namespace fixed

namespace variable {
inline constexpr std::size_t kEnsembleLow = 2;
inline constexpr std::size_t kClock = 4;  ///< yy mm dd hh mm ss cc
inline constexpr std::size_t kEnsembleHigh = 11;
inline constexpr std::size_t kSoundSpeed = 14;
inline constexpr std::size_t kHeading = 18;
inline constexpr std::size_t kPitch = 20;
inline constexpr std::size_t kRoll = 22;
inline constexpr std::size_t kSalinity = 24;
inline constexpr std::size_t kTemperature = 26;
inline constexpr std::size_t kShortest = 28;
inline constexpr std::size_t kFullClock = 57;  ///< century yy mm dd hh mm ss cc
inline constexpr std::size_t kFull = 65;
}  // namespace variable

namespace bottom {
inline constexpr std::size_t kPings = 2;
inline constexpr std::size_t kMode = 9;
inline constexpr std::size_t kRange = 16;
inline constexpr std::size_t kVelocity = 24;
inline constexpr std::size_t kCorrelation = 32;
inline constexpr std::size_t kPercentGood = 40;
inline constexpr std::size_t kShortest = 44;
inline constexpr std::size_t kWaterVelocity = 50;
inline constexpr std::size_t kWaterPercentGood = 66;
inline constexpr std::size_t kWaterEnd = 70;
inline constexpr std::size_t kRangeHigh = 77;
inline constexpr std::size_t kFull = 81;
}  // namespace bottom

namespace high_resolution {
inline constexpr std::size_t kVelocity = 2;        ///< 0.01 mm/s, of the vehicle
inline constexpr std::size_t kWaterVelocity = 34;  ///< likewise
inline constexpr std::size_t kSoundSpeed = 66;     ///< 1e-6 m/s
inline constexpr std::size_t kFull = 70;
}  // namespace high_resolution

namespace range {
inline constexpr std::size_t kVertical = 10;  ///< 0.1 mm
inline constexpr std::size_t kShortest = 17;
}  // namespace range

namespace navigation {
inline constexpr std::size_t kBottomSigma = 18;  ///< mm/s
inline constexpr std::size_t kWaterSigma = 45;
inline constexpr std::size_t kShortest = 53;
}  // namespace navigation

}  // namespace fathom::codec::pd0

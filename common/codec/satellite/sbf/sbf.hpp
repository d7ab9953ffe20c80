#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "codec/registry.hpp"

namespace fathom::codec {

/// Septentrio receivers (mosaic, AsteRx, PolaRx): blocks of the Septentrio Binary Format (mosaic-X5 Reference
/// Guide, SBF Reference). PVTGeodetic becomes a GpsSample, AttEuler a HeadingSample. All other blocks are
/// good frames without sample; NMEA, RTCM and the answers to commands between them are skipped.
///
/// Blocks of one instant are joined (Epochs): the covariances of PosCovGeodetic and VelCovGeodetic with
/// the fix, that of AttCovEuler with the heading. EndOfPVT and EndOfAtt, where they are sent, end the
/// waiting.
///
/// Sigmas: those of the covariances, by axis. Without them HAccuracy and VAccuracy, which PVTGeodetic has
/// from revision 2 on, count for the position. HAccuracy is twice the root mean square of the horizontal
/// distance (2DRMS): one axis has 1 / (2 sqrt(2)) of it. VAccuracy is two sigmas.
///
/// Fix: RTK fixed and float as such; differential, SBAS and precise point positions are differential. A
/// moving-base RTK position is differential as well, without sigma: fixed or float, the receiver knows how
/// good its line to the base is, and not where the base is. A fixed location was told to the receiver and is
/// no measurement. Two-dimensional is what assumes its height, which is unknown then. There is no fix with an
/// error code, and none of which the receiver says that the test of its integrity has failed. Coordinates in
/// a datum that a user has defined are refused: nobody knows how far it is from WGS 84.
///
/// What RFStatus says of jamming and spoofing (SbfInterference) goes into the fixes that follow.
///
/// Heading: that of AttEuler, from the main antenna to the first auxiliary one, turned by the offset that the
/// receiver was told. It is unknown without attitude, and where the ambiguities are not fixed. Pitch and roll
/// are not used.
///
/// Time: time of the week and week are GPS time. UTC follows with the leap seconds of the last ReceiverTime,
/// before it with those that the project knows. Latency is the age of a fix at its transmission.
[[nodiscard]] std::unique_ptr<Codec> make_sbf(const CodecOptions& options);

namespace sbf {

inline constexpr std::uint8_t kSync1 = 0x24;  // $
inline constexpr std::uint8_t kSync2 = 0x40;  // @
/// Synchronisation bytes, CRC, identification and length. The CRC covers what follows it.
inline constexpr std::size_t kHeader = 8;
inline constexpr std::size_t kSummedFrom = 4;
/// Longest block believed; raw measurements of a hundred satellites stay below.
inline constexpr std::size_t kMostLength = 8192;

/// The lower 13 bits of the identification. The upper three are the revision.
enum Block : std::uint16_t {
  pvt_geodetic = 4007,
  rf_status = 4092,
  position_covariance = 5906,
  velocity_covariance = 5908,
  receiver_time = 5914,
  end_of_pvt = 5921,
  att_euler = 5938,
  att_covariance = 5939,
  end_of_att = 5943,
};

/// What stands in a field without value.
inline constexpr double kDoNotUse = -2e10;
inline constexpr std::uint8_t kDoNotUse8 = 0xFF;
inline constexpr std::uint16_t kDoNotUse16 = 0xFFFF;
inline constexpr std::uint32_t kDoNotUse32 = 0xFFFF'FFFF;
inline constexpr std::int8_t kDoNotUseSigned = -128;

/// Of the mode of a position, bits 0 to 3.
enum class Solution : std::uint8_t {
  none = 0,
  single = 1,
  differential = 2,
  told = 3,
  rtk_fixed = 4,
  rtk_float = 5,
  sbas = 6,
  moving_base_fixed = 7,
  moving_base_float = 8,
  ppp = 10,
};
inline constexpr unsigned kTwoDimensional = 1U << 7U;  ///< of the mode

/// Of the mode of an attitude.
inline constexpr unsigned kAttitudeFixed = 2;          ///< heading and pitch, fixed ambiguities
inline constexpr unsigned kFullAttitudeFixed = 4;      ///< roll as well, by a third antenna
inline constexpr unsigned kNotEnoughMeasurements = 1;  ///< of the error of its first baseline

}  // namespace sbf
}  // namespace fathom::codec

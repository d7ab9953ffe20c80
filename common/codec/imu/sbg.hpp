#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "codec/registry.hpp"

namespace fathom::codec {

/// SBG Systems (Ellipse, Pulse, Quanta, Ekinox, Apogee): sbgECom frames with the logs IMU_SHORT (44) or
/// IMU_DATA (03), both of class 0 (sbgECom, doc/binaryMessages.md of release 5: IMU measurements, status and
/// time), and those of the satellite receivers, GPS1_VEL (13), GPS1_POS (14), GPS1_HDT (15), and GPS2_VEL,
/// GPS2_POS and GPS2_HDT (16 to 18). While IMU_SHORT comes, IMU_DATA is ignored: both say the same. UTC_TIME
/// (02) gives UTC. All other logs and classes are ignored, with them the unit's own filter, and so are the
/// pages of large transfers.
///
/// Axes: the unit's body frame, forward, right, down in its factory alignment. Forces are specific forces:
/// level and at rest z reads -1 g. What the unit's own alignment turns is turned already.
///
/// What the logs call delta velocity and delta angle are means over the output interval in m/s^2 and rad/s.
/// They are rates here; no increments, whose interval no log says.
///
/// Status: while the link to the inertial sensors or their built-in test fails, all axes are unknown; an axis
/// is that whose own test fails, and a triad of which any axis leaves its range.
///
/// Time: microseconds since the unit was switched on, carried on where their 32 bits begin again after 71
/// minutes. UTC where the last UTC_TIME is at most 10 s away, its clock has converged to the pulse per
/// second, and it knows the leap seconds.
///
/// Satellite fix (section GNSS position and velocity of the same document): position and velocity of one time
/// of the week make one sample (FixEpochs); what comes of the second receiver counts where the first is not
/// heard (FirstReceiver). Accuracies are of one sigma and by axis. A solution of unknown kind is no fix, a
/// precise point position a differential one, and a position that somebody has set no measurement. Instant:
/// the time stamp is that of the position data, not of the unit's loop, and so stands for the unit's clock.
/// UTC is that of the fix's time of the week, by UTC_TIME, which says both, and within a second of the
/// stamp's.
///
/// Heading by two antennas (GPS1_HDT): degrees of true north, of the line from the main antenna to the other,
/// with an accuracy of one sigma. Without a solution, or where the accuracy is half a turn or more, it is a
/// sample of unknown heading. Stamp and UTC are as those of a fix; the second receiver's heading counts where
/// the first is not heard with one. Pitch and length of the line are not used.
[[nodiscard]] std::unique_ptr<Codec> make_sbg(const CodecOptions& options);

namespace sbg {

inline constexpr std::uint8_t kSync1 = 0xFF;
inline constexpr std::uint8_t kSync2 = 0x5A;
inline constexpr std::uint8_t kEnd = 0x33;
inline constexpr std::size_t kMostData = 4086;

/// Of class 0.
enum Log : std::uint8_t {
  utc_time = 2,
  imu_data = 3,
  gps1_velocity = 13,
  gps1_position = 14,
  gps1_heading = 15,
  gps2_velocity = 16,
  gps2_position = 17,
  gps2_heading = 18,
  imu_short = 44,
};

/// Of both inertial logs. All but the last are set while all is well.
enum Status : std::uint16_t {
  link = 1U << 0U,
  self_test = 1U << 1U,
  accelerometer_x = 1U << 2U,  ///< then y, z
  gyro_x = 1U << 5U,           ///< then y, z
  accelerometers_in_range = 1U << 8U,
  gyros_in_range = 1U << 9U,
  high_rate_scale = 1U << 10U,  ///< IMU_SHORT: rates in the coarser of its two units
};
inline constexpr unsigned kAllWell = 0x3FF;

/// Counts of IMU_SHORT.
inline constexpr double kForceCounts = 1'048'576.0;      ///< for 1 m/s^2
inline constexpr double kRateCounts = 67'108'864.0;      ///< for 1 rad/s
inline constexpr double kHighRateCounts = 12'304'174.0;  ///< for 1 rad/s
inline constexpr double kTemperatureCounts = 256.0;      ///< for 1 degC

/// Of UTC_TIME: what the two fields of its status have to be.
inline constexpr unsigned kClockValid = 3;      ///< bits 1 to 4
inline constexpr unsigned kUtcInitialized = 2;  ///< bits 6 to 9

/// CRC-16 (polynomial 0x8408, reflected, initially 0), sent low byte first, over all between the two
/// synchronisation bytes and it.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes);

}  // namespace sbg
}  // namespace fathom::codec

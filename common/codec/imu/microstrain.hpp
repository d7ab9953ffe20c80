#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "codec/registry.hpp"

namespace fathom::codec {

/// MicroStrain (LORD, Parker, HBK) 3DM units: MIP packets of descriptor set 0x80, sensor data, and of the
/// sets of the satellite receivers (3DM-CV7 and 3DM-GX5 Data Communications Protocol: MIP packet; Sensor
/// Data, set 0x80; GNSS Data, set 0x81; Shared Data, set 0xFF). Packets of other sets are ignored, and with
/// them what the unit's own filter says (0x82). So are packets of sensor data without both an angular rate
/// and a force, or their increments, and those that an event sent beside the scheduled ones (field 0xD0).
///
/// Axes: those of the unit's vehicle frame, forward, right, down. It is the frame printed on the unit unless
/// somebody has told the unit another one. Level and at rest z of the accelerometer is -1 g.
///
/// Rates and forces: scaled gyro (0x05, rad/s) and scaled accelerometer (0x04, g). Increments: delta theta
/// (0x07, rad) and delta velocity (0x08, g s). The maker's g is 9.80665 m/s^2. Where there is nothing else,
/// rates and forces are increments over their interval. An axis that the overrange status (0x18) names is
/// unknown.
///
/// Interval of the increments: what they are summed over is the time since the last packet with them. The
/// reference time delta (0xD6) says it, as long as no packet without increments has had that field as well,
/// which the first packet with increments cannot know. Else it is the delta time (0xD4) of the clock that is
/// synchronized, or the difference of the unit's clock to the packet with increments before, where it is
/// within a tenth of the shortest of the last eight: packets have no numbers, and a longer difference is one
/// in which packets were lost or the clock was set. Increments of unknown interval are unknown.
///
/// Time: the reference time (0xD5, ns) as free-running clock. Units that do not have it send a GPS timestamp
/// (0xD3 or 0x12), which is their own clock where nobody has set it. UTC from the GPS timestamp where its
/// flags say so: of 0xD3 time of week and week; of 0x12 pulse per second present and time set (3DM-GX5-35,
/// section 5.1.12, GPS Correlation Timestamp), and, of newer units, which say that as well, week and time of
/// week valid.
///
/// Satellite fix: a packet of set 0x81 or 0x91 with a position (0x03), and of 0x92, the second antenna's,
/// where no other is heard (FirstReceiver). Velocity (0x05), horizontal dilution (0x07) and fix info (0x0B)
/// are those of the same packet. A number is known where its own flag says so, and position and velocity
/// while the fix info calls the fix one; without that field the flag of the position decides. Accuracies: the
/// maker's definitions (mip_sdk, data_gnss.h) say metres and no more; its driver for ROS takes the horizontal
/// one for the deviation of each axis, north and east, and so does this codec: it is the cautious reading.
/// UTC from the receiver's GPS time (0x09), else from its UTC (0x08) with known leap seconds. No clock: the
/// reference time of such a packet need not be the instant of the fix.
[[nodiscard]] std::unique_ptr<Codec> make_microstrain(const CodecOptions& options);

namespace microstrain {

inline constexpr std::array<std::uint8_t, 2> kSync{0x75, 0x65};
inline constexpr std::uint8_t kSensorData = 0x80;  ///< descriptor set

/// Descriptors of fields in that set. Those from 0xD0 on are the same in every set of data.
enum Field : std::uint8_t {
  scaled_accel = 0x04,
  scaled_gyro = 0x05,
  delta_theta = 0x07,
  delta_velocity = 0x08,
  gps_timestamp = 0x12,
  overrange_status = 0x18,
  event_source = 0xD0,
  shared_gps_timestamp = 0xD3,
  delta_time = 0xD4,
  reference_time = 0xD5,
  reference_time_delta = 0xD6,
};

}  // namespace microstrain
}  // namespace fathom::codec

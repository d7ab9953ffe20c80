#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace fathom::codec::vectornav {

inline constexpr std::uint8_t kSync = 0xFA;
inline constexpr std::size_t kGroups = 7;
inline constexpr std::size_t kCrcBytes = 2;

/// Groups and fields as the frame's masks number them. Only those that are read have a name.
enum Group : std::size_t { common = 0, time = 1, imu = 2, gnss1 = 3, attitude = 4, ins = 5, gnss2 = 6 };
namespace common_field {
enum Field : std::size_t {
  time_startup = 0,
  time_gps = 1,
  angular_rate = 5,
  accel = 8,
  imu = 9,
  mag_pres = 10,
  deltas = 11
};
}
namespace time_field {
enum Field : std::size_t { startup = 0, gps = 1, utc = 6, status = 9 };
}
namespace imu_field {
enum Field : std::size_t {
  uncomp_accel = 2,
  uncomp_gyro = 3,
  temperature = 4,
  delta_theta = 6,
  delta_velocity = 7,
  accel = 9,
  angular_rate = 10
};
}
namespace gnss_field {
enum Field : std::size_t {
  utc = 0,
  tow = 1,
  week = 2,
  num_sats = 3,
  fix = 4,
  pos_lla = 5,
  vel_ned = 7,
  pos_u = 9,
  vel_u = 10,
  time_info = 12,
  dop = 13
};
}

/// Where each field of a frame lies, from the sync byte; 0 for a field that is absent.
struct Layout {
  enum class State : std::uint8_t { complete, more_needed, unknown_field };
  State state = State::more_needed;
  std::size_t length = 2;  ///< of the whole frame with CRC; bytes wanted while more_needed
  using Fields = std::array<std::size_t, 16>;
  std::array<Fields, kGroups> at{};
};

/// Reads masks (and the counts of the fields of variable length) of the frame that starts at front[0].
[[nodiscard]] Layout read_layout(std::span<const std::uint8_t> front);

}  // namespace fathom::codec::vectornav

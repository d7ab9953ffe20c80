#pragma once

#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "samples/gps.hpp"

namespace fathom::codec::microstrain {

/// Sets of the receivers: the one of a unit with one antenna, and those of a unit with two.
inline constexpr std::uint8_t kGnss = 0x81;
inline constexpr std::uint8_t kGnss1 = 0x91;
inline constexpr std::uint8_t kGnss2 = 0x92;

/// Descriptors of fields in these sets.
enum GnssField : std::uint8_t {
  position_llh = 0x03,
  velocity_ned = 0x05,
  dilution = 0x07,
  utc_time = 0x08,
  gps_time = 0x09,
  fix_info = 0x0B,
};

/// Of the fix info.
enum class FixType : std::uint8_t {
  fix_3d = 0,
  fix_2d = 1,
  time_only = 2,
  none = 3,
  invalid = 4,
  rtk_float = 5,
  rtk_fixed = 6,
  differential = 7,
};

/// Time since the GPS epoch, as fields of several sets say it: time of the week (s), week, flags.
struct GpsTime {
  DurationNs since_epoch_ns = 0;  ///< of the unit's own clock where it is not valid
  bool valid = false;
};
/// Why the field is refused; nothing in `into` where its numbers mean nothing and do not claim to.
[[nodiscard]] std::optional<RejectReason> read_gps_time(Bytes data, bool (*is_valid)(std::uint16_t flags),
                                                        std::optional<GpsTime>& into);
/// By the flags of the GPS timestamp that all sets share, and of the receiver's GPS time.
[[nodiscard]] bool week_and_time_valid(std::uint16_t flags);

/// What one packet of a receiver's set has.
class GnssData {
 public:
  /// Why the field is refused; nothing when it is good or one that nobody reads.
  [[nodiscard]] std::optional<RejectReason> take(std::uint8_t descriptor, Bytes data);

  [[nodiscard]] bool has_position() const { return has_position_; }
  [[nodiscard]] bool scheduled() const { return event_ == 0; }
  [[nodiscard]] GpsSample sample() const;
  [[nodiscard]] DeviceTime time() const;

 private:
  std::optional<RejectReason> take_position(Bytes data);
  std::optional<RejectReason> take_velocity(Bytes data);
  std::optional<RejectReason> take_dilution(Bytes data);
  std::optional<RejectReason> take_utc(Bytes data);
  std::optional<RejectReason> take_fix_info(Bytes data);
  [[nodiscard]] GpsFix fix() const;

  GpsSample got_;  ///< all but the fix
  bool has_position_ = false;
  std::optional<GpsFix> told_fix_;
  std::optional<GpsTime> gps_;
  std::optional<TimeNs> utc_ns_;
  std::uint8_t event_ = 0;
};

}  // namespace fathom::codec::microstrain

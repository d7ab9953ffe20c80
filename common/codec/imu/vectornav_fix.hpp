#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "codec/imu/vectornav_layout.hpp"
#include "samples/gps.hpp"

namespace fathom::codec::vectornav {

/// UTC of a field TimeUtc (years since 2000, fraction in ms, which may be negative); nothing when it is none.
[[nodiscard]] std::optional<TimeNs> utc_of_civil(Bytes frame, std::size_t at);

/// Bits of TimeStatus, and of the first byte of TimeInfo.
enum TimeStatus : std::uint8_t { time_ok = 1, date_ok = 2, utc_ok = 4 };

/// The fixes of the receivers in the unit, each of them once: the frames repeat the last one at their own
/// rate.
///
/// A fix is new when Tow or Fix of its group have changed. Where Tow is not in the frame TimeUtc counts in
/// its place, and where neither is, position, velocity and satellites.
class Fixes {
 public:
  struct Found {
    std::optional<RejectReason> refused;
    GpsSample sample;
    DeviceTime time;
  };
  /// What the frame says, where it is new: that of GNSS1, or of GNSS2 in a stream without GNSS1. Groups
  /// without Fix, or with neither position nor velocity, say nothing.
  [[nodiscard]] std::optional<Found> take(Bytes frame, const Layout& layout);

 private:
  /// What tells a fix from the one before, and of what kind it is.
  struct Key {
    enum class Kind : std::uint8_t { none, values, utc, tow };  ///< the better the later
    Kind kind = Kind::none;
    std::uint8_t fix = 0;
    std::array<std::uint8_t, 40> bytes{};
    bool operator==(const Key&) const = default;
  };
  static Key key_of(Bytes frame, const Layout::Fields& group);

  bool has_gnss1_ = false;
  Key last_;
};

}  // namespace fathom::codec::vectornav

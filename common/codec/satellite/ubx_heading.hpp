#pragma once

#include <cstdint>
#include <optional>

#include "base/time.hpp"
#include "codec/codec.hpp"
#include "codec/framer.hpp"
#include "samples/heading.hpp"

namespace fathom::codec {

inline constexpr std::uint8_t kUbxRelposned = 0x3C;

/// NAV-RELPOSNED version 1 of a receiver whose reference moves with it (moving base): the true direction from
/// the reference's antenna to its own. One with a reference that stands still gives a baseline to the shore,
/// which is no heading, and version 0 has none.
class UbxHeading {
 public:
  struct Found {
    std::optional<RejectReason> refused;
    HeadingSample sample;  ///< unknown heading where the receiver does not vouch for it, or has not fixed it
    DeviceTime time;
  };
  /// Nothing where the message holds no heading of the vehicle.
  [[nodiscard]] std::optional<Found> read(Bytes payload) const;

  /// Time of the week and UTC of a solution: from it that of a heading follows, for ten seconds.
  void note(std::uint32_t time_of_week_ms, const std::optional<TimeNs>& utc_ns);

 private:
  std::uint32_t time_of_week_ms_ = 0;
  std::optional<TimeNs> utc_ns_;
};

}  // namespace fathom::codec

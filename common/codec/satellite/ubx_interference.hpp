#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "codec/framer.hpp"
#include "samples/gps.hpp"

namespace fathom::codec {

/// What a u-blox receiver says of jamming and spoofing besides its fixes: NAV-STATUS (spoofDetState), MON-HW
/// and MON-RF (jammingState), SEC-SIG versions 1 and 2 (both).
///
/// Of several messages the worst counts. A message counts for the next kFixesHeld fixes, so that one that is
/// no longer sent does not speak for ever.
class UbxInterference {
 public:
  static constexpr int kFixesHeld = 50;

  /// Why one of the messages above is refused: nothing when it was believed, or is another message.
  std::optional<RejectReason> read(std::uint8_t message_class, std::uint8_t id, Bytes payload);

  /// What has been said, into a fix that comes now.
  void stamp(GpsSample& fix);

 private:
  enum Message : std::uint8_t { nav_status, mon_hw, mon_rf, sec_sig, kMessages };
  struct Said {
    GpsJamming jamming = GpsJamming::unknown;
    GpsSpoofing spoofing = GpsSpoofing::unknown;
    int fixes_left = 0;
  };
  std::optional<RejectReason> note(Message message, unsigned jamming_state, unsigned spoofing_state);

  std::array<Said, kMessages> said_{};
};

}  // namespace fathom::codec

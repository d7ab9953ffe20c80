#pragma once

#include <optional>

#include "base/time.hpp"
#include "codec/framer.hpp"
#include "codec/satellite/sbf/blocks.hpp"
#include "samples/gps.hpp"

namespace fathom::codec::sbf {

/// What a receiver says of interference in RFStatus. A suspicion that signals are not authentic indicates
/// spoofing; together with a failed authentication of the navigation messages it affirms it. Interference in
/// any band is a warning. It is critical where nothing is done against it and there is no fix.
///
/// It counts for the fixes of the next kHolds_ns, so that a block that is no longer sent does not speak for
/// ever; while the receiver does not know its time, for the next kFixesHeld fixes.
class SbfInterference {
 public:
  static constexpr DurationNs kHolds_ns = 10 * kNsPerSecond;
  static constexpr int kFixesHeld = 50;

  /// Why the block is refused; nothing when it was believed.
  [[nodiscard]] std::optional<RejectReason> read(Bytes block);
  /// What has been said, into a fix of this instant.
  void stamp(GpsSample& fix, const GpsInstant& at);

 private:
  struct Said {
    GpsInstant at;
    GpsSpoofing spoofing = GpsSpoofing::none;
    bool interfered = false;
    bool unmitigated = false;
    int fixes_left = kFixesHeld;
  };
  std::optional<Said> said_;
};

}  // namespace fathom::codec::sbf

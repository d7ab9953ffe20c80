#pragma once

#include <optional>

#include "codec/text/nmea_sentence.hpp"
#include "samples/usbl.hpp"

namespace fathom::codec {

/// Where the ship is and where it heads, from the GGA and HDT or THS sentences that a topside merges into the
/// stream of its acoustic fixes. A fix relative to the ship cannot be placed without.
///
/// The position is taken as that of the point to which the fixes refer, and it must be of the fix's time
/// within kFreshest. A heading has no time: it serves the next kFixes fixes. The vessel's axes of PSIMSSB are
/// levelled by its maker, so roll and pitch are zero.
class ShipPose {
 public:
  /// Keeps what the sentence says; any other, or one without fix, is passed over.
  void note(const Sentence& sentence);
  /// Adds the ship to a relative fix that was valid at this time of day, as far as it is known.
  void give(UsblSample& sample, std::optional<DurationNs> time_of_day);

 private:
  static constexpr DurationNs kFreshest = 2 * kNsPerSecond;
  static constexpr int kFixes = 3;

  std::optional<DurationNs> position_time_;
  double latitude_rad_ = kUnknown;
  double longitude_rad_ = kUnknown;
  double heading_rad_ = kUnknown;
  int heading_left_ = 0;  ///< fixes that it still serves
};

}  // namespace fathom::codec

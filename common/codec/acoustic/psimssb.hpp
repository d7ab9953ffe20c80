#pragma once

#include <optional>

#include "base/device_time.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "samples/usbl.hpp"

namespace fathom::codec {

/// Kongsberg $PSIMSSB, one acoustic fix.
///
/// Cartesian coordinates along the vessel (H), north (N) or east (E), and radians with north (R, G:
/// latitude, longitude). UTM and polar coordinates are good sentences that give no sample: `usable` is false
/// (of UTM the zone is not said, of polar coordinates not whether their range is slant or level). A fix
/// without reply, marked invalid or with an error code, gives a sample with unknown position: what its
/// coordinates hold is a prediction or zero. The accuracy's statistics are not defined by its maker; it is
/// taken as the sigma of one axis, the careful reading, and not below `sigma_floor_m`.
[[nodiscard]] std::optional<RejectReason> parse_psimssb(const Sentence& sentence, double sigma_floor_m,
                                                        UsblSample& sample, DeviceTime& time, bool& usable);

}  // namespace fathom::codec

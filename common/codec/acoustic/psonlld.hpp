#pragma once

#include <optional>

#include "base/device_time.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "samples/usbl.hpp"

namespace fathom::codec {

/// Sonardyne $PSONLLD (Ranger 2 and Mini-Ranger 2), one acoustic fix in latitude, longitude and depth:
/// time of validity (UTC), beacon, A or V, degrees, metres down, then the error ellipse as semi-axes of one
/// sigma and the direction of the larger, and the sigma of the depth. Fields behind these are not read.
///
/// A fix that is marked V gives a sample with unknown position. `sigma_m` is the larger semi-axis, which the
/// error of no direction exceeds; it is not below `sigma_floor_m`, and unknown where both semi-axes are
/// empty or zero.
[[nodiscard]] std::optional<RejectReason> parse_psonlld(const Sentence& sentence, double sigma_floor_m,
                                                        UsblSample& sample, DeviceTime& time);

}  // namespace fathom::codec

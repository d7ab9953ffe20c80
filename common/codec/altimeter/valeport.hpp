#pragma once

#include <optional>

#include "codec/depth/depth_scale.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "samples/altimeter.hpp"
#include "samples/depth.hpp"

namespace fathom::codec {

/// What a PRVAT says.
struct ValeportReport {
  AltimeterSample altimeter;
  std::optional<DepthSample> depth;  ///< of a model with a pressure sensor
};

/// `PRVAT,range,M[,pressure,dBar]` of Valeport's altimeters (VA500): metres to the bottom, and the absolute
/// pressure. An empty range is unknown: the instrument is alive and hears no bottom. Where one of the two
/// cannot be, the other is kept: a range that cannot be is unknown, a pressure that cannot be gives no depth.
/// Nor does one in metres, because nothing says whether it begins at the surface. Refused is what has
/// neither and says something that cannot be. `dbar` makes a depth of a pressure in decibar.
[[nodiscard]] std::optional<RejectReason> parse_valeport(const Sentence& sentence, const DepthScale& dbar,
                                                         ValeportReport& report);

}  // namespace fathom::codec

#pragma once

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// Height above the bottom, as an echo sounder measures it.
struct AltimeterSample {
  SampleHeader header;
  double altitude_m = kUnknown;  ///< from the transducer to the bottom
  double sigma_m = kUnknown;
  double transducer_offset_m =
      kUnknown;           ///< as told by the device: to the waterline positive, to the keel negative
  bool vertical = false;  ///< the device has taken out its tilt; else it is the way along its own axis
};

}  // namespace fathom

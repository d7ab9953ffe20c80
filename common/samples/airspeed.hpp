#pragma once

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

struct AirspeedSample {
  SampleHeader header;
  double airspeed_m_s = kUnknown;     ///< indicated
  double baro_altitude_m = kUnknown;  ///< up
  double sigma_m_s = kUnknown;        ///< of either airspeed
  /// From the air's own density; where known it is used and the indicated one is not.
  double true_airspeed_m_s = kUnknown;
};

}  // namespace fathom

#pragma once

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

struct DepthSample {
  SampleHeader header;
  double depth_m = kUnknown;  ///< of the pressure port below the surface, down positive
  double sigma_m = kUnknown;
  double pressure_Pa = kUnknown;  ///< absolute, as measured
  double temperature_degC = kUnknown;
};

}  // namespace fathom

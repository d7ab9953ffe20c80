#pragma once

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

struct PropulsionSample {
  SampleHeader header;
  double rpm = kUnknown;  ///< of the shaft, negative astern
};

/// Fin deflections, positive by the right-hand rule about the body axes they turn around.
struct FinsSample {
  SampleHeader header;
  double rudder_rad = kUnknown;
  double stern_rad = kUnknown;
};

}  // namespace fathom

#pragma once

#include <array>

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// Where the simulated vehicle really is, or where the reference of a recorded data set says it was.
/// For scoring only: no navigation service has a reader for it.
struct Truth {
  SampleHeader header;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double altitude_m = kUnknown;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  std::array<double, 3> rpy_rad{kUnknown, kUnknown, kUnknown};
  bool gps_available = true;
};

}  // namespace fathom

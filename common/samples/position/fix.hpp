#pragma once

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// A position that somebody tells: a person, a ship by radio, a modem. header.stamp_ns is the instant at
/// which the vehicle was there, header.received_ns when it was told, which may be minutes later;
/// header.sensor says who tells it.
struct FixSample {
  SampleHeader header;
  double latitude_rad = kUnknown;
  double longitude_rad = kUnknown;
  double sigma_m = kUnknown;        ///< of north, and of east
  double depth_m = kUnknown;        ///< below the surface, down; unknown: not told
  double depth_sigma_m = kUnknown;  ///< unknown: that of the configuration
};

}  // namespace fathom

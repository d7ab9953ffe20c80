#pragma once

#include "base/unknown.hpp"
#include "samples/header.hpp"

namespace fathom {

/// Slant range to a beacon, as an acoustic modem or a long-baseline transceiver measures it. The stamp is
/// when the sound met the beacon or left it, so that the range is that of one instant.
struct RangeSample {
  SampleHeader header;
  Name beacon;  ///< its address, as the instrument tells it
  double range_m = kUnknown;
  double sigma_m = kUnknown;
  double travel_time_s = kUnknown;        ///< one way
  double beacon_latitude_rad = kUnknown;  ///< unknown where the bridge is not told about this beacon
  double beacon_longitude_rad = kUnknown;
  double beacon_depth_m = kUnknown;  ///< below the surface, down
};

}  // namespace fathom

#pragma once

#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "samples/dvl.hpp"

namespace fathom::sim::encode {

struct Pd0Options {
  std::uint32_t ensemble = 1;        ///< number, grows by one
  double heading_alignment_rad = 0;  ///< from forward to beam 3, as CodecOptions::dvl_heading_alignment_rad
  bool high_resolution = true;       ///< adds 0x5803: 0.01 mm/s instead of 1 mm/s
};

/// One PD0 ensemble of a downward-looking convex DVL, its velocity in the frame that
/// bottom.recorded_frame names; unknown components are sent as bad. `clock_ns` is what the instrument's
/// real-time clock shows (sent to 10 ms). A known velocity without error velocity is sent as three-beam
/// solution.
///
/// In beam axes, beams the sample does not know are computed from the velocity when that is known. In earth
/// axes the sample must know its attitude, else the velocity is sent as bad. `water`, where given, is the
/// same instrument's velocity relative to the water layer.
[[nodiscard]] std::vector<std::uint8_t> pd0(const DvlSample& bottom, TimeNs clock_ns,
                                            const Pd0Options& options = {}, const DvlSample* water = nullptr);

}  // namespace fathom::sim::encode

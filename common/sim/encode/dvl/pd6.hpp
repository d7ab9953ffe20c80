#pragma once

#include <string>

#include "base/time.hpp"
#include "samples/dvl.hpp"

namespace fathom::sim::encode {

/// One ping of PD6 as a downward-looking Teledyne DVL writes it, to 1 mm/s, 1 cm and 10 ms. The frame that
/// bottom.recorded_frame names is the first that is sent: from instrument (and beam) axes on :BI :BS :BE,
/// from ship axes on :BS :BE, from earth axes on :BE alone. A velocity with an unknown component is sent as
/// bad, an unknown altitude as 0, an unknown attitude as 0 with :BE bad. A known velocity without error
/// velocity is sent as three-beam solution. `clock_ns` is what the instrument's clock shows. `water`, where
/// given, is the same instrument's velocity relative to the water layer. `heading_alignment_rad` is the angle
/// from forward to beam 3, as CodecOptions::dvl_heading_alignment_rad.
[[nodiscard]] std::string pd6(const DvlSample& bottom, TimeNs clock_ns, double heading_alignment_rad = 0.0,
                              const DvlSample* water = nullptr);

}  // namespace fathom::sim::encode

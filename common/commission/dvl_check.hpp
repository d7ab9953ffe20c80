#pragma once

#include "commission/assumed.hpp"
#include "commission/commission.hpp"
#include "commission/finding.hpp"
#include "commission/fit/dvl_fit.hpp"

namespace fathom::commission {

/// From windows as long as serves them best: longer ones hold more motion and more of the drift of the gyro.
/// Mirror, unit, mounting, scale, lever and time offset of the DVL against the inertial unit.
struct DvlCheck {
  Findings findings;
  VectorSeries velocity_B;  ///< corrected, in body axes; of the inertial unit's place
};
[[nodiscard]] DvlCheck check_dvl(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                 double latency_s, Patch& patch);

}  // namespace fathom::commission

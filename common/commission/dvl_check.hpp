#pragma once

#include "commission/assumed.hpp"
#include "commission/commission.hpp"
#include "commission/dvl_found.hpp"
#include "commission/finding.hpp"

namespace fathom::commission {

/// Mirror, unit, mounting, scale, lever and time offset of the DVL against the inertial unit.
struct DvlCheck {
  Findings findings;
  VectorSeries velocity_B;  ///< corrected, in body axes; of the inertial unit's place
};
[[nodiscard]] DvlCheck check_dvl(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                 const DvlFound& found, Patch& patch);

}  // namespace fathom::commission

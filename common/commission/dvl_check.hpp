#pragma once

#include "commission/assumed.hpp"
#include "commission/commission.hpp"
#include "commission/finding.hpp"
#include "commission/fit/dvl_fit.hpp"

namespace fathom::commission {

/// What the windows of a log tell of the DVL.
struct DvlFound {
  DvlFigures fit;
  bool mirrored = false;
  bool mirror_told = false;
};
/// From windows as long as serves them best: longer ones hold more motion and more of the drift of the gyro.
[[nodiscard]] DvlFound find_dvl(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                double latency_s);

/// Mirror, unit, mounting, scale, lever and time offset of the DVL against the inertial unit.
struct DvlCheck {
  Findings findings;
  VectorSeries velocity_B;  ///< corrected, in body axes; of the inertial unit's place
};
[[nodiscard]] DvlCheck check_dvl(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                 const DvlFound& found, Patch& patch);

}  // namespace fathom::commission

#pragma once

#include "commission/assumed.hpp"
#include "commission/finding.hpp"
#include "commission/fit/joint_fit.hpp"
#include "commission/fit/strapdown.hpp"

namespace fathom::commission {

/// The depth against the vertical velocity of the DVL (body axes): sign, unit, time offset. Where the joint
/// fit was done, the time offset is against the way down of that.
[[nodiscard]] Findings check_depth(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                   const VectorSeries& dvl_B, const JointFit& joint);

}  // namespace fathom::commission

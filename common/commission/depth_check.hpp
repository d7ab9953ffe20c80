#pragma once

#include "commission/assumed.hpp"
#include "commission/finding.hpp"
#include "commission/fit/strapdown.hpp"

namespace fathom::commission {

/// The depth against the vertical velocity of the DVL (body axes): sign, unit, time offset.
[[nodiscard]] Findings check_depth(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                   const VectorSeries& dvl_B);

}  // namespace fathom::commission

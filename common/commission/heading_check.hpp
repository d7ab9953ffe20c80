#pragma once

#include "commission/assumed.hpp"
#include "commission/finding.hpp"
#include "commission/fit/joint_fit.hpp"
#include "commission/fit/strapdown.hpp"
#include "commission/gps_check.hpp"

namespace fathom::commission {

/// Sum of squares of the turn of the compass less that of the gyro about the vertical, rad^2.
[[nodiscard]] double heading_squares(const Series& series, const ImuReading& reading);

/// The compass against the gyro: sense of turning, time offset; against the course over ground: what it reads
/// too much. `dvl_B` is the velocity of the vehicle in body axes where it is known. Where the joint fit was
/// done, time offset and what it reads too much are against the attitude of that.
[[nodiscard]] Findings check_heading(const Series& series, const Assumed& assumed, const ImuReading& reading,
                                     const GpsCheck& gps, const VectorSeries& dvl_B, const JointFit& joint);

/// Vertical axis of the body, down, over about `half_s` to both sides: what the accelerometer feels on
/// average.
[[nodiscard]] VectorSeries down_of(const Series& series, const ImuReading& reading, double half_s);

}  // namespace fathom::commission

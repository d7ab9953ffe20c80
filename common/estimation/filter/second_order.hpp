#pragma once

#include <Eigen/Core>

#include "estimation/filter/error_filter.hpp"

namespace fathom::estimation {

/// What the rows of a velocity along the vehicle see beyond the first order where attitude and velocity are
/// both uncertain (AID-DVL-4): its mean is taken off the innovation, its variance is noise. `velocity_N_m_s`
/// is the estimate of what they measure. A row whose variance would change by less than a hundredth stays as
/// it is.
void add_second_order_of_velocity(const ErrorFilter& filter, const Eigen::Vector3d& velocity_N_m_s,
                                  Observation& observation);

/// The same of the one row of a heading (AID-HDG-3), which turns with the roll of a vehicle that is pitched.
/// A tilt that stays does the same to every heading meanwhile: `again_s` is the time since the one before.
void add_second_order_of_heading(const ErrorFilter& filter, const Eigen::Matrix3d& C_NB, double again_s,
                                 Observation& observation);

}  // namespace fathom::estimation

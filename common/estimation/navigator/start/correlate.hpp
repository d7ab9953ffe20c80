#pragma once

#include "estimation/navigator/setup.hpp"

/// A start carries the errors of the instruments that it is found with (ALN-5, ALN-21, ALN-23): the filter
/// must know, or it unlearns what it cannot know better.
namespace fathom::estimation {

/// What bias, scale and misalignment of the accelerometers did to the attitude. `rotation_by_force` is the
/// attitude error about N by an error of the specific force along B, rad/(m/s^2); `force_B_m_s2` what was
/// felt.
void correlate_accelerometers(const Setup& setup, const Eigen::Matrix3d& rotation_by_force,
                              const Eigen::Vector3d& force_B_m_s2, ErrorFilter& filter);
/// The same of the gyros: `rotation_by_rate` in s.
void correlate_gyros(const Setup& setup, const Eigen::Matrix3d& rotation_by_rate,
                     const Eigen::Vector3d& rate_B_rad_s, ErrorFilter& filter);
/// What bias and misalignment of an acoustic system did to the position: `turned_N_m` by the latter, per
/// radian about the transceiver's axes.
void correlate_usbl(const Setup& setup, const Eigen::Matrix3d& turned_N_m, ErrorFilter& filter);

/// What a heading found too far clockwise turns where that is all it does.
inline const Eigen::Vector3d kByHeading = -Eigen::Vector3d::UnitZ();
/// What the slow error of two antennas did to an attitude that has its heading from them, and is as uncertain
/// as they are: `by_heading` is the rotation about N by a heading that is found too far clockwise.
void correlate_antennas(const Setup& setup, const Eigen::Vector3d& by_heading, ErrorFilter& filter);

}  // namespace fathom::estimation

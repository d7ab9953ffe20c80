#pragma once

#include <optional>

#include <Eigen/Core>

#include "base/result.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "ros2/frames/convention.hpp"
#include "ros2/frames/odom_frame.hpp"
#include "samples/nav_state.hpp"

namespace fathom::ros2 {

/// Attitude and rates as ROS 2 says them.
struct Attitude {
  TimeNs stamp_ns = 0;
  geo::Quaternion q_WF;
  Eigen::Matrix3d rotation_covariance_W;  ///< rad^2, about the axes of W
  Eigen::Vector3d angular_rate_F_rad_s;
  Eigen::Vector3d specific_force_F_m_s2;
};

/// Place and speed besides.
struct Motion {
  NavMode mode = NavMode::none;
  geo::Geodetic place;
  Eigen::Matrix3d position_covariance_ENU;  ///< m^2, for NavSatFix, whatever the convention
  MapMotion map;
  Eigen::Matrix3d position_covariance_W;  ///< m^2
  Eigen::Vector3d velocity_F_m_s;
  Eigen::Matrix3d velocity_covariance_F;  ///< (m/s)^2
};

/// Nothing usable: the error says what is not known.
[[nodiscard]] Result<Attitude> attitude_of(const NavState& state, Convention convention);

/// Likewise. `origin` is that of the frame map; the place in it is that of geo::difference_N(): metres along
/// the meridian and the parallel.
[[nodiscard]] Result<Motion> motion_of(const NavState& state, Convention convention,
                                       const geo::Geodetic& origin);

/// Where the state says the vehicle is; nothing where it does not.
[[nodiscard]] std::optional<geo::Geodetic> place_of(const NavState& state);

}  // namespace fathom::ros2

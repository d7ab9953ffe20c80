#pragma once

#include <string>
#include <vector>

#include "ros2/messages/geometry.hpp"
#include "ros2/messages/sensors.hpp"
#include "ros2/output/motion.hpp"

namespace fathom::ros2 {

struct FrameNames {
  std::string map = "map";
  std::string odom = "odom";
  std::string base_link = "base_link";
};

/// What the navigation state does not say and a covariance has to: standard deviations of one component.
struct RateNoise {
  double angular_rate_rad_s = 0.002;
  double specific_force_m_s2 = 0.05;
};

/// Of an instant: ROS 2 counts seconds in 32 bits, until 2038. Saturates.
[[nodiscard]] Time time_of(TimeNs stamp_ns);

[[nodiscard]] Odometry odometry(const Motion& motion, const Attitude& attitude, const OdomFrame& odom,
                                const FrameNames& names, const RateNoise& noise);
[[nodiscard]] Imu imu(const Attitude& attitude, const FrameNames& names, const RateNoise& noise);
/// A satellite fix where satellites aid, else "no fix" with the position that navigation has.
[[nodiscard]] NavSatFix nav_sat_fix(const Motion& motion, const FrameNames& names);
[[nodiscard]] TwistWithCovarianceStamped twist(const Motion& motion, const Attitude& attitude,
                                               const FrameNames& names, const RateNoise& noise);
[[nodiscard]] PoseWithCovarianceStamped pose(const Motion& motion, const Attitude& attitude,
                                             const FrameNames& names);
/// The orientation in the axes of map.
[[nodiscard]] GeoPoseStamped geo_pose(const Motion& motion, const FrameNames& names);
/// Where the frame map begins.
[[nodiscard]] GeoPoseStamped map_origin(TimeNs stamp_ns, const geo::Geodetic& origin,
                                        const FrameNames& names);

[[nodiscard]] TransformStamped transform(TimeNs stamp_ns, const std::string& parent, const std::string& child,
                                         const FramePose& pose);

}  // namespace fathom::ros2

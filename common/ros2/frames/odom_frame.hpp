#pragma once

#include <Eigen/Core>

#include "base/time.hpp"
#include "geo/so3.hpp"

namespace fathom::ros2 {

struct FramePose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  geo::Quaternion q;  ///< turns the inner frame's axes into the outer's
};

/// The motion of the body in map, in the axes W and F of a convention.
struct MapMotion {
  TimeNs stamp_ns = 0;
  FramePose pose;                                            ///< of base_link in map
  Eigen::Vector3d velocity_W_m_s = Eigen::Vector3d::Zero();  ///< over the bottom
  Eigen::Vector3d angular_rate_F_rad_s = Eigen::Vector3d::Zero();
};

/// Keeps the frame `odom` of REP-105: in it the body moves as it is said to be fast and never jumps, so that
/// it drifts. What is known of the drift, and every step of the position or of the heading, is in map ->
/// odom. Begins with both frames in one.
class OdomFrame {
 public:
  /// A change of attitude that the rates do not explain and that is larger than this is a step: its part
  /// about the vertical goes into map -> odom. Smaller ones, the filter's daily corrections, stay in odom.
  static constexpr double kHeadingStep_rad = 0.02;
  /// Over a longer time rates explain nothing.
  static constexpr DurationNs kLongest_ns = kNsPerSecond;

  /// The next motion. Precondition: its stamp is later than that of the last one.
  void update(const MapMotion& motion);

  [[nodiscard]] const FramePose& map_from_odom() const { return map_from_odom_; }
  [[nodiscard]] const FramePose& odom_from_base() const { return odom_from_base_; }

 private:
  bool started_ = false;
  MapMotion last_;
  double yaw_rad_ = 0.0;  ///< of odom in map
  FramePose map_from_odom_;
  FramePose odom_from_base_;
};

}  // namespace fathom::ros2

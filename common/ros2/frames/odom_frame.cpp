#include "ros2/frames/odom_frame.hpp"

#include <cassert>

namespace fathom::ros2 {
namespace {

geo::Quaternion about_vertical(double angle_rad) {
  return geo::exp({0.0, 0.0, angle_rad});
}

/// What the attitude turned about the vertical beyond what the rates say; 0 where that is no step.
double heading_step(const MapMotion& from, const MapMotion& to) {
  const DurationNs dt_ns = to.stamp_ns - from.stamp_ns;
  if (dt_ns > OdomFrame::kLongest_ns) return 0.0;
  const Eigen::Vector3d turn_F =
      0.5 * to_seconds(dt_ns) * (from.angular_rate_F_rad_s + to.angular_rate_F_rad_s);
  const geo::Quaternion expected = from.pose.q * geo::exp(turn_F);
  const Eigen::Vector3d beyond_W = geo::log(geo::normalized(to.pose.q * geo::conjugate(expected)));
  return beyond_W.norm() > OdomFrame::kHeadingStep_rad ? beyond_W.z() : 0.0;
}

}  // namespace

void OdomFrame::update(const MapMotion& motion) {
  if (!started_) {
    odom_from_base_ = motion.pose;
    last_ = motion;
    started_ = true;
    return;
  }
  assert(motion.stamp_ns > last_.stamp_ns);
  const double dt_s = to_seconds(motion.stamp_ns - last_.stamp_ns);
  // The way was gone with the heading as it was thought to be.
  const Eigen::Vector3d way_W = 0.5 * dt_s * (last_.velocity_W_m_s + motion.velocity_W_m_s);
  odom_from_base_.position_m += geo::to_matrix(about_vertical(-yaw_rad_)) * way_W;
  yaw_rad_ += heading_step(last_, motion);
  const geo::Quaternion q_MO = about_vertical(yaw_rad_);
  odom_from_base_.q = geo::normalized(geo::conjugate(q_MO) * motion.pose.q);
  map_from_odom_.q = q_MO;
  map_from_odom_.position_m = motion.pose.position_m - geo::to_matrix(q_MO) * odom_from_base_.position_m;
  last_ = motion;
}

}  // namespace fathom::ros2

#include "ros2/output/messages.hpp"

#include <algorithm>
#include <limits>

#include "base/units.hpp"

namespace fathom::ros2 {
namespace {

Header header_of(TimeNs stamp_ns, const std::string& frame) {
  return {time_of(stamp_ns), frame};
}

Eigen::Matrix3d sphere(double sigma) {
  return sigma * sigma * Eigen::Matrix3d::Identity();
}

Pose pose_of(const FramePose& pose) {
  return {point(pose.position_m), quaternion(pose.q)};
}

TwistWithCovariance twist_of(const Motion& motion, const Attitude& attitude, const RateNoise& noise) {
  return {{vector3(motion.velocity_F_m_s), vector3(attitude.angular_rate_F_rad_s)},
          covariance6(motion.velocity_covariance_F, sphere(noise.angular_rate_rad_s))};
}

GeoPoint geo_point(const geo::Geodetic& place) {
  return {place.latitude_rad / kRadPerDeg, geo::wrap_pi(place.longitude_rad) / kRadPerDeg, place.altitude_m};
}

}  // namespace

Time time_of(TimeNs stamp_ns) {
  std::int64_t seconds = stamp_ns / kNsPerSecond;
  std::int64_t rest = stamp_ns % kNsPerSecond;
  if (rest < 0) {
    rest += kNsPerSecond;
    --seconds;
  }
  const std::int64_t sec = std::clamp<std::int64_t>(seconds, std::numeric_limits<std::int32_t>::min(),
                                                    std::numeric_limits<std::int32_t>::max());
  return {static_cast<std::int32_t>(sec), static_cast<std::uint32_t>(rest)};
}

Odometry odometry(const Motion& motion, const Attitude& attitude, const OdomFrame& odom,
                  const FrameNames& names, const RateNoise& noise) {
  const Eigen::Matrix3d R_OM = geo::to_matrix(geo::conjugate(odom.map_from_odom().q));
  return {header_of(motion.map.stamp_ns, names.odom),
          names.base_link,
          {pose_of(odom.odom_from_base()), covariance6(rotated(R_OM, motion.position_covariance_W),
                                                       rotated(R_OM, attitude.rotation_covariance_W))},
          twist_of(motion, attitude, noise)};
}

Imu imu(const Attitude& attitude, const FrameNames& names, const RateNoise& noise) {
  Imu out;
  out.header = header_of(attitude.stamp_ns, names.base_link);
  out.orientation = quaternion(attitude.q_WF);
  out.orientation_covariance = covariance3(attitude.rotation_covariance_W);
  out.angular_velocity = vector3(attitude.angular_rate_F_rad_s);
  out.angular_velocity_covariance = covariance3(sphere(noise.angular_rate_rad_s));
  out.linear_acceleration = vector3(attitude.specific_force_F_m_s2);
  out.linear_acceleration_covariance = covariance3(sphere(noise.specific_force_m_s2));
  return out;
}

NavSatFix nav_sat_fix(const Motion& motion, const FrameNames& names) {
  NavSatFix out;
  out.header = header_of(motion.map.stamp_ns, names.base_link);
  if (motion.mode == NavMode::gps_aided) out.status = {NavSatStatus::kFix, NavSatStatus::kGps};
  const GeoPoint at = geo_point(motion.place);
  out.latitude = at.latitude;
  out.longitude = at.longitude;
  out.altitude = at.altitude;
  out.position_covariance = covariance3(motion.position_covariance_ENU);
  out.position_covariance_type = NavSatFix::kKnownCovariance;
  return out;
}

TwistWithCovarianceStamped twist(const Motion& motion, const Attitude& attitude, const FrameNames& names,
                                 const RateNoise& noise) {
  return {header_of(motion.map.stamp_ns, names.base_link), twist_of(motion, attitude, noise)};
}

PoseWithCovarianceStamped pose(const Motion& motion, const Attitude& attitude, const FrameNames& names) {
  return {
      header_of(motion.map.stamp_ns, names.map),
      {pose_of(motion.map.pose), covariance6(motion.position_covariance_W, attitude.rotation_covariance_W)}};
}

GeoPoseStamped geo_pose(const Motion& motion, const FrameNames& names) {
  return {header_of(motion.map.stamp_ns, names.map),
          {geo_point(motion.place), quaternion(motion.map.pose.q)}};
}

GeoPoseStamped map_origin(TimeNs stamp_ns, const geo::Geodetic& origin, const FrameNames& names) {
  return {header_of(stamp_ns, names.map), {geo_point(origin), Quaternion{}}};
}

TransformStamped transform(TimeNs stamp_ns, const std::string& parent, const std::string& child,
                           const FramePose& pose) {
  return {header_of(stamp_ns, parent), child, {vector3(pose.position_m), quaternion(pose.q)}};
}

}  // namespace fathom::ros2

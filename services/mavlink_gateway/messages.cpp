#include "mavlink_gateway/messages.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "base/units.hpp"
#include "geo/so3.hpp"
#include "samples/position/gives_position.hpp"
#include "samples/uncertainty.hpp"

namespace fathom::mavlink_gateway {
namespace {

using config::MavlinkFrame;
using config::MavlinkGatewayConfig;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kBestRadius_m = 0.01;
constexpr std::uint8_t kFrameLocalNed = 1;
constexpr std::uint8_t kFrameBodyFrd = 12;
constexpr std::uint8_t kFrameLocalFrd = 20;
constexpr std::uint8_t kEstimatorGpsIns = 4;
constexpr std::uint8_t kTypeOnboardController = 18;
constexpr std::uint8_t kAutopilotInvalid = 8;
constexpr std::uint8_t kStateStandby = 3;
constexpr std::uint8_t kStateActive = 4;
constexpr std::uint8_t kStateCritical = 5;
constexpr std::int64_t kGpsMinusUtc_s = 18;        // since 2017
constexpr std::int64_t kGpsEpoch_s = 315'964'800;  // 1980-01-06
constexpr std::int64_t kWeek_ms = 7LL * 24 * 3600 * 1000;
constexpr std::uint16_t kIgnoreHdop = 2;
constexpr std::uint16_t kIgnoreVdop = 4;
constexpr std::uint8_t kFix3d = 3;
/// Sigma of roll and pitch that a state without one is told with.
constexpr double kUnknownTilt_rad = 0.1;

Vector3d vector_of(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}
Matrix3d matrix_of(const std::array<double, 9>& m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data());
}
Matrix3d C_NB_of(const NavState& state) {
  return geo::to_matrix({state.q_NB[0], state.q_NB[1], state.q_NB[2], state.q_NB[3]});
}

/// The upper triangle of a 6 x 6 matrix of two blocks that know nothing of each other.
std::array<float, 21> triangle_of(const Matrix3d& first, const Matrix3d& second) {
  std::array<float, 21> out{};
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column, ++at) {
      if (row < 3 && column < 3) out[at] = static_cast<float>(first(row, column));
      if (row >= 3 && column >= 3) out[at] = static_cast<float>(second(row - 3, column - 3));
    }
  return out;
}

Matrix3d attitude_covariance(const NavState& state) {
  Matrix3d out = Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double sigma = state.rpy_sigma_rad[static_cast<std::size_t>(i)];
    const double used = std::isfinite(sigma) ? sigma : kUnknownTilt_rad;
    out(i, i) = used * used;
  }
  return out;
}

std::uint64_t microseconds(TimeNs ns) {
  return static_cast<std::uint64_t>(std::max<TimeNs>(0, ns) / 1000);
}

std::int32_t e7(double radians) {
  return static_cast<std::int32_t>(std::llround(radians * kDegPerRad * 1e7));
}

bool all_finite(const NavState& s) {
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::isfinite(s.latitude_rad) && std::isfinite(s.longitude_rad) && std::isfinite(s.altitude_m) &&
         std::all_of(s.velocity_N_m_s.begin(), s.velocity_N_m_s.end(), finite) &&
         std::all_of(s.q_NB.begin(), s.q_NB.end(), finite) &&
         std::all_of(s.rpy_rad.begin(), s.rpy_rad.end(), finite) &&
         std::all_of(s.position_covariance_N_m2.begin(), s.position_covariance_N_m2.end(), finite) &&
         std::all_of(s.velocity_covariance_N_m2_s2.begin(), s.velocity_covariance_N_m2_s2.end(), finite);
}

}  // namespace

std::optional<Pose> pose_of(const NavState& state, const MavlinkGatewayConfig& config) {
  if (!gives_position(state.mode) || !all_finite(state)) return std::nullopt;
  if (!(state.rpy_sigma_rad[2] <= config.valid_heading_rad)) return std::nullopt;
  const Vector3d lever_B = vector_of(config.point_B_m);
  const Matrix3d C_NB = C_NB_of(state);
  Vector3d rate = vector_of(state.angular_rate_B_rad_s);
  if (!rate.allFinite()) rate.setZero();
  Pose out{
      .state = state,
      .place = geo::moved_by({state.latitude_rad, state.longitude_rad, state.altitude_m}, C_NB * lever_B),
      .v_N_m_s = vector_of(state.velocity_N_m_s) + C_NB * rate.cross(lever_B),
      .radius_95_m = horizontal_95_m(state.position_covariance_N_m2)};
  return out;
}

std::int8_t quality_of(double radius_95_m, double valid_95_m) {
  if (!(radius_95_m <= valid_95_m)) return -1;
  if (radius_95_m <= kBestRadius_m) return 100;
  const double share = std::log(radius_95_m / kBestRadius_m) / std::log(valid_95_m / kBestRadius_m);
  return static_cast<std::int8_t>(std::lround(100.0 - 99.0 * share));
}

mavlink::Odometry odometry_of(const Pose& pose, const geo::Geodetic& origin,
                              const MavlinkGatewayConfig& config) {
  const NavState& state = pose.state;
  mavlink::Odometry out;
  out.time_usec = microseconds(state.header.stamp_ns);
  out.frame_id = config.frame == MavlinkFrame::local_ned ? kFrameLocalNed : kFrameLocalFrd;
  out.child_frame_id = kFrameBodyFrd;
  const Vector3d place = geo::difference_N(origin, pose.place);
  out.x = static_cast<float>(place.x());
  out.y = static_cast<float>(place.y());
  out.z = static_cast<float>(place.z());
  for (std::size_t i = 0; i < 4; ++i) out.q[i] = static_cast<float>(state.q_NB[i]);
  const Matrix3d C_BN = C_NB_of(state).transpose();
  const Vector3d v_B = C_BN * pose.v_N_m_s;
  out.vx = static_cast<float>(v_B.x());
  out.vy = static_cast<float>(v_B.y());
  out.vz = static_cast<float>(v_B.z());
  out.rollspeed = static_cast<float>(state.angular_rate_B_rad_s[0]);
  out.pitchspeed = static_cast<float>(state.angular_rate_B_rad_s[1]);
  out.yawspeed = static_cast<float>(state.angular_rate_B_rad_s[2]);
  out.pose_covariance = triangle_of(matrix_of(state.position_covariance_N_m2), attitude_covariance(state));
  // Nobody has told how well the rates are known: not at all, on the diagonal.
  out.velocity_covariance =
      triangle_of(C_BN * matrix_of(state.velocity_covariance_N_m2_s2) * C_BN.transpose(),
                  Matrix3d(Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()).asDiagonal()));
  out.reset_counter = static_cast<std::uint8_t>(state.reset_counter);
  out.estimator_type = kEstimatorGpsIns;
  out.quality = quality_of(pose.radius_95_m, config.valid_95_m);
  return out;
}

mavlink::VisionPositionEstimate vision_of(const Pose& pose, const geo::Geodetic& origin) {
  const Vector3d place = geo::difference_N(origin, pose.place);
  mavlink::VisionPositionEstimate out;
  out.usec = microseconds(pose.state.header.stamp_ns);
  out.x = static_cast<float>(place.x());
  out.y = static_cast<float>(place.y());
  out.z = static_cast<float>(place.z());
  out.roll = static_cast<float>(pose.state.rpy_rad[0]);
  out.pitch = static_cast<float>(pose.state.rpy_rad[1]);
  out.yaw = static_cast<float>(pose.state.rpy_rad[2]);
  out.covariance =
      triangle_of(matrix_of(pose.state.position_covariance_N_m2), attitude_covariance(pose.state));
  out.reset_counter = static_cast<std::uint8_t>(pose.state.reset_counter);
  return out;
}

mavlink::GpsInput gps_input_of(const Pose& pose, const MavlinkGatewayConfig& config) {
  const auto& covariance = pose.state.position_covariance_N_m2;
  const auto& v_covariance = pose.state.velocity_covariance_N_m2_s2;
  mavlink::GpsInput out;
  out.time_usec = microseconds(pose.state.header.stamp_ns);
  const std::int64_t gps_ms =
      pose.state.header.stamp_ns / kNsPerMillisecond + (kGpsMinusUtc_s - kGpsEpoch_s) * 1000;
  out.time_week = static_cast<std::uint16_t>(gps_ms / kWeek_ms);
  out.time_week_ms = static_cast<std::uint32_t>(gps_ms % kWeek_ms);
  out.ignore_flags = kIgnoreHdop | kIgnoreVdop;
  out.fix_type = pose.radius_95_m <= config.valid_95_m ? kFix3d : 0;
  out.lat = e7(pose.place.latitude_rad);
  out.lon = e7(std::remainder(pose.place.longitude_rad, 2.0 * std::numbers::pi));
  out.alt = static_cast<float>(pose.place.altitude_m - config.geoid_height_m);
  out.vn = static_cast<float>(pose.v_N_m_s.x());
  out.ve = static_cast<float>(pose.v_N_m_s.y());
  out.vd = static_cast<float>(pose.v_N_m_s.z());
  out.horiz_accuracy = static_cast<float>(std::sqrt(covariance[0] + covariance[4]));
  out.vert_accuracy = static_cast<float>(std::sqrt(covariance[8]));
  out.speed_accuracy = static_cast<float>(std::sqrt(v_covariance[0] + v_covariance[4]));
  // 0 means that there is none, so that north is 36000.
  double yaw_deg = pose.state.rpy_rad[2] * kDegPerRad;
  if (yaw_deg < 0.0) yaw_deg += 360.0;
  const auto hundredths = static_cast<std::uint16_t>(std::lround(yaw_deg * 100.0) % 36'000);
  out.yaw = hundredths == 0 ? 36'000 : hundredths;
  return out;
}

mavlink::Heartbeat heartbeat_of(const std::optional<NavState>& state, bool is_fresh) {
  mavlink::Heartbeat out;
  out.type = kTypeOnboardController;
  out.autopilot = kAutopilotInvalid;
  const bool has_position = state && gives_position(state->mode);
  out.system_status = !state         ? kStateStandby
                      : !is_fresh    ? kStateCritical
                      : has_position ? kStateActive
                                     : kStateStandby;
  return out;
}

}  // namespace fathom::mavlink_gateway

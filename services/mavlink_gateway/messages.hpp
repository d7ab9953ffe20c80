#pragma once

#include <optional>

#include "config/doors/mavlink_gateway_config.hpp"
#include "geo/wgs84.hpp"
#include "mavlink/messages.hpp"
#include "samples/nav_state.hpp"

namespace fathom::mavlink_gateway {

/// A navigation state at the point of the vehicle that is told.
struct Pose {
  NavState state;           ///< of the inertial unit
  geo::Geodetic place;      ///< of the point
  Eigen::Vector3d v_N_m_s;  ///< of the point
  double radius_95_m = kUnknown;
};

/// Nothing where the state gives no position, velocity and attitude to be used, or a heading whose sigma is
/// above the limit: an autopilot would take the turn for motion.
[[nodiscard]] std::optional<Pose> pose_of(const NavState& state, const config::MavlinkGatewayConfig& config);

/// Percent: 100 for a position known to a centimetre, 1 at `valid_95_m`, falling with its logarithm; -1
/// beyond.
[[nodiscard]] std::int8_t quality_of(double radius_95_m, double valid_95_m);

/// Position from `origin` in north-east-down, twist in forward-right-down, covariances of both.
[[nodiscard]] mavlink::Odometry odometry_of(const Pose& pose, const geo::Geodetic& origin,
                                            const config::MavlinkGatewayConfig& config);
[[nodiscard]] mavlink::VisionPositionEstimate vision_of(const Pose& pose, const geo::Geodetic& origin);
[[nodiscard]] mavlink::GpsInput gps_input_of(const Pose& pose, const config::MavlinkGatewayConfig& config);
[[nodiscard]] mavlink::Heartbeat heartbeat_of(const std::optional<NavState>& state, bool is_fresh);

}  // namespace fathom::mavlink_gateway

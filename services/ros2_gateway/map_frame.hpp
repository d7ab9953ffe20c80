#pragma once

#include <optional>

#include "base/unknown.hpp"
#include "config/doors/ros2_gateway_config.hpp"
#include "geo/wgs84.hpp"
#include "ros2/frames/convention.hpp"

/// The frame map as it is configured.
namespace fathom::ros2_gateway {

[[nodiscard]] inline ros2::Convention convention_of(const config::RosFramesConfig& frames) {
  return frames.convention == config::RosConvention::enu_flu ? ros2::Convention::enu_flu
                                                             : ros2::Convention::ned_frd;
}

/// Nothing where it begins where the vehicle is first.
[[nodiscard]] inline std::optional<geo::Geodetic> configured_origin(const config::RosFramesConfig& frames) {
  if (!known(frames.origin_latitude_rad)) return std::nullopt;
  return geo::Geodetic{frames.origin_latitude_rad, frames.origin_longitude_rad, frames.origin_altitude_m};
}

}  // namespace fathom::ros2_gateway

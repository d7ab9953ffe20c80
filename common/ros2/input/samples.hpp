#pragma once

#include <array>
#include <cstdint>

#include "geo/wgs84.hpp"
#include "ros2/frames/convention.hpp"
#include "ros2/input/door.hpp"
#include "ros2/messages/sensors.hpp"
#include "samples/depth.hpp"
#include "samples/dvl.hpp"
#include "samples/gps.hpp"
#include "samples/imu.hpp"
#include "samples/position/fix.hpp"

/// Messages as samples. Units, axes and unknown quantities are fathom's afterwards; the values are finite
/// where they are known. Limits of what an instrument can mean are those of a bridge and not checked here.
namespace fathom::ros2 {

/// How the sender names the axes of its frame.
enum class Axes : std::uint8_t { flu = 0, frd = 1 };

struct ImuRule {
  std::array<double, 9> R_BS{1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major; turns the message's axes into B
};
/// REP-145: specific force with gravity. A message without one of both triads is refused.
[[nodiscard]] Entry<ImuSample> imu_sample(const Imu& message, const SampleHeader& header,
                                          const ImuRule& rule);

/// Without a fix the sample says so and has no position.
[[nodiscard]] Entry<GpsSample> gps_sample(const NavSatFix& message, const SampleHeader& header);

struct PressureRule {
  double latitude_rad = 0.0;
  double atmosphere_Pa = 101'325.0;  ///< 0: the messages are of gauge pressure
};
[[nodiscard]] Entry<DepthSample> depth_sample(const FluidPressure& message, const SampleHeader& header,
                                              const PressureRule& rule);

struct VelocityRule {
  Axes axes = Axes::frd;
  DvlMode mode = DvlMode::bottom;  ///< of messages that do not say it
};
/// The velocity has no components where fewer than three beams are good. Beam velocities are left out: their
/// sign is not agreed on.
[[nodiscard]] Entry<DvlSample> dvl_sample(const Dvl& message, const SampleHeader& header,
                                          const VelocityRule& rule);
[[nodiscard]] Entry<DvlSample> dvl_sample(const TwistWithCovarianceStamped& message,
                                          const SampleHeader& header, const VelocityRule& rule);

struct PoseRule {
  geo::Geodetic origin;  ///< of the frame map
  Convention convention = Convention::enu_flu;
};
/// The horizontal place alone: heights in map are above the ellipsoid and no depths, and the attitude is
/// estimated. The sigma of the sample is that along the longest axis of the ellipse. Refused without one.
[[nodiscard]] Entry<FixSample> fix_sample(const PoseWithCovarianceStamped& message,
                                          const SampleHeader& header, const PoseRule& rule);

}  // namespace fathom::ros2

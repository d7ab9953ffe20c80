#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace fathom::guidance {

/// A place to pass through, in metres north and east of one origin.
struct PathPoint {
  double north_m = 0.0;
  double east_m = 0.0;
  double depth_m = 0.0;
  double speed_m_s = 1.0;
};

/// What the autopilot is asked for, and how the leg stands.
struct SteeringOrder {
  double course_rad = 0.0;   ///< over ground, [0, 2 pi)
  double heading_rad = 0.0;  ///< course corrected for drift, [0, 2 pi)
  double speed_m_s = 0.0;    ///< 0 when the mission is over
  double depth_m = 0.0;
  double cross_track_m = 0.0;     ///< right of the leg positive
  double distance_to_go_m = 0.0;  ///< to the waypoint of this leg
  std::size_t waypoint = 0;       ///< index of that waypoint
  std::size_t reached = 0;        ///< waypoints reached since the start
  bool finished = false;
};

/// Where the vehicle is and how it moves over ground.
struct PathState {
  double north_m = 0.0;
  double east_m = 0.0;
  double velocity_north_m_s = 0.0;
  double velocity_east_m_s = 0.0;
  double yaw_rad = 0.0;
};

/// Line-of-sight guidance along straight legs: the course points at the spot `lookahead_m` ahead on the leg,
/// course = leg direction - atan(cross track / lookahead). Pure. The first leg begins where the vehicle is at
/// the first call. A waypoint is reached within `acceptance_m`, or when the vehicle has passed abeam of it.
class LineOfSight {
 public:
  struct Options {
    double lookahead_m = 15.0;
    double acceptance_m = 10.0;
    bool repeat = false;
  };
  /// Precondition: at least one waypoint.
  LineOfSight(std::vector<PathPoint> waypoints, const Options& options);

  [[nodiscard]] SteeringOrder steer(const PathState& state);

 private:
  struct Leg {
    double direction_rad = 0.0;
    double length_m = 0.0;
    double along_m = 0.0;
    double cross_m = 0.0;
    double to_go_m = 0.0;
  };
  [[nodiscard]] Leg leg_at(const PathState& state) const;
  void next_leg(const PathState& state);

  std::vector<PathPoint> waypoints_;
  Options options_;
  std::optional<PathPoint> from_;
  std::size_t to_ = 0;
  std::size_t reached_ = 0;
  bool finished_ = false;
};

}  // namespace fathom::guidance

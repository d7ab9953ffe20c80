#include "guidance_example/line_of_sight.hpp"

#include <cassert>
#include <cmath>
#include <utility>

#include "geo/wgs84.hpp"

namespace fathom::guidance {
namespace {

// Slower than this the course over ground says nothing about drift.
constexpr double kDriftSpeed_m_s = 0.3;

}  // namespace

LineOfSight::LineOfSight(std::vector<PathPoint> waypoints, const Options& options)
    : waypoints_(std::move(waypoints)), options_(options) {
  assert(!waypoints_.empty());
}

LineOfSight::Leg LineOfSight::leg_at(const PathState& state) const {
  const PathPoint& to = waypoints_[to_];
  const double north = to.north_m - from_->north_m;
  const double east = to.east_m - from_->east_m;
  Leg leg;
  leg.length_m = std::hypot(north, east);
  leg.to_go_m = std::hypot(to.north_m - state.north_m, to.east_m - state.east_m);
  // A leg without length has the direction of what is left to go.
  leg.direction_rad = leg.length_m > 0.0 ? std::atan2(east, north)
                                         : std::atan2(to.east_m - state.east_m, to.north_m - state.north_m);
  const double dn = state.north_m - from_->north_m;
  const double de = state.east_m - from_->east_m;
  leg.along_m = dn * std::cos(leg.direction_rad) + de * std::sin(leg.direction_rad);
  leg.cross_m = -dn * std::sin(leg.direction_rad) + de * std::cos(leg.direction_rad);
  return leg;
}

void LineOfSight::next_leg(const PathState& state) {
  // At most once around: waypoints closer together than the acceptance radius must not spin for ever.
  for (std::size_t i = 0; i < waypoints_.size() && !finished_; ++i) {
    const Leg leg = leg_at(state);
    if (leg.to_go_m > options_.acceptance_m && leg.along_m < leg.length_m) return;
    ++reached_;
    from_ = waypoints_[to_];
    if (to_ + 1 < waypoints_.size()) {
      ++to_;
    } else if (options_.repeat) {
      to_ = 0;
    } else {
      finished_ = true;
    }
  }
}

SteeringOrder LineOfSight::steer(const PathState& state) {
  if (!from_) from_ = PathPoint{state.north_m, state.east_m, 0.0, 0.0};
  next_leg(state);
  const Leg leg = leg_at(state);
  const PathPoint& to = waypoints_[to_];
  SteeringOrder order;
  order.waypoint = to_;
  order.reached = reached_;
  order.finished = finished_;
  order.depth_m = to.depth_m;
  order.speed_m_s = finished_ ? 0.0 : to.speed_m_s;
  order.cross_track_m = leg.cross_m;
  order.distance_to_go_m = leg.to_go_m;
  order.course_rad = geo::wrap_two_pi(leg.direction_rad - std::atan2(leg.cross_m, options_.lookahead_m));
  double drift_rad = 0.0;
  if (std::hypot(state.velocity_north_m_s, state.velocity_east_m_s) > kDriftSpeed_m_s) {
    drift_rad = geo::wrap_pi(std::atan2(state.velocity_east_m_s, state.velocity_north_m_s) - state.yaw_rad);
  }
  // Backwards is no drift.
  if (std::abs(drift_rad) > 1.0) drift_rad = 0.0;
  order.heading_rad = geo::wrap_two_pi(order.course_rad - drift_rad);
  return order;
}

}  // namespace fathom::guidance

#pragma once

#include <Eigen/Core>

#include "base/time.hpp"
#include "base/unknown.hpp"
#include "geo/wgs84.hpp"
#include "sim/simulation.hpp"

namespace fathom::study {

/// The classical way without an IMU: the latest DVL velocity, held in the vehicle's axes, turned by the
/// compass and summed from one compass reading to the next. Level vehicle; what the instruments say is
/// believed.
class DeadReckoning {
 public:
  explicit DeadReckoning(const geo::Geodetic& start) : position_(start) {}
  void take(const sim::Measurement& measurement);
  [[nodiscard]] const geo::Geodetic& position() const { return position_; }

 private:
  void turn(TimeNs stamp_ns, double heading_rad);

  geo::Geodetic position_;
  Eigen::Vector2d v_B_m_s_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d v_N_m_s_ = Eigen::Vector2d::Zero();
  TimeNs stamp_ns_ = 0;
  bool started_ = false;
};

}  // namespace fathom::study

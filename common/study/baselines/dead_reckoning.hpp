#pragma once

#include <vector>

#include <Eigen/Core>

#include "base/time.hpp"
#include "geo/wgs84.hpp"
#include "sim/simulation.hpp"

namespace fathom::study {

/// The classical way without an IMU: DVL velocity along the vehicle's axes, linear between its readings,
/// turned by the compass and summed from one compass reading to the next (STUDY-1). Level vehicle; what the
/// instruments say is believed.
class DeadReckoning {
 public:
  explicit DeadReckoning(const geo::Geodetic& start) : position_(start) {}
  void take(const sim::Measurement& measurement);
  /// Now; after the last DVL reading its velocity is held.
  [[nodiscard]] geo::Geodetic position() const;

 private:
  struct Bearing {
    TimeNs stamp_ns = 0;
    double heading_rad = 0.0;
  };
  void settle(TimeNs stamp_ns, const Eigen::Vector2d& v_B_m_s);
  void turn(const Bearing& compass, const Eigen::Vector2d& v_B_m_s);

  geo::Geodetic position_;
  Eigen::Vector2d v_B_m_s_ = Eigen::Vector2d::Zero();  ///< of the last DVL reading
  TimeNs dvl_ns_ = 0;
  std::vector<Bearing> waiting_;  ///< compass readings since then
  Eigen::Vector2d v_N_m_s_ = Eigen::Vector2d::Zero();
  TimeNs summed_ns_ = 0;
};

}  // namespace fathom::study

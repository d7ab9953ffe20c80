#include "study/baselines/dead_reckoning.hpp"

#include <cmath>
#include <variant>

#include "base/unknown.hpp"

namespace fathom::study {

void DeadReckoning::take(const sim::Measurement& measurement) {
  if (const auto* dvl = std::get_if<DvlSample>(&measurement)) {
    const auto& v = dvl->velocity_D_m_s;
    if (known(v[0]) && known(v[1])) settle(dvl->header.stamp_ns, {v[0], v[1]});
  }
  if (const auto* compass = std::get_if<HeadingSample>(&measurement)) {
    if (known(compass->heading_rad)) waiting_.push_back({compass->header.stamp_ns, compass->heading_rad});
  }
}

geo::Geodetic DeadReckoning::position() const {
  DeadReckoning held = *this;
  for (const Bearing& one : waiting_) held.turn(one, v_B_m_s_);
  return held.position_;
}

void DeadReckoning::settle(TimeNs stamp_ns, const Eigen::Vector2d& v_B_m_s) {
  for (const Bearing& one : waiting_) {
    const double share =
        dvl_ns_ == 0 ? 1.0 : to_seconds(one.stamp_ns - dvl_ns_) / to_seconds(stamp_ns - dvl_ns_);
    turn(one, v_B_m_s_ + share * (v_B_m_s - v_B_m_s_));
  }
  waiting_.clear();
  v_B_m_s_ = v_B_m_s;
  dvl_ns_ = stamp_ns;
}

void DeadReckoning::turn(const Bearing& compass, const Eigen::Vector2d& v_B_m_s) {
  const double sine = std::sin(compass.heading_rad);
  const double cosine = std::cos(compass.heading_rad);
  const Eigen::Vector2d v_N(cosine * v_B_m_s.x() - sine * v_B_m_s.y(),
                            sine * v_B_m_s.x() + cosine * v_B_m_s.y());
  if (summed_ns_ != 0) {
    const Eigen::Vector2d moved = 0.5 * to_seconds(compass.stamp_ns - summed_ns_) * (v_N_m_s_ + v_N);
    position_ = geo::moved_by(position_, {moved.x(), moved.y(), 0.0});
  }
  v_N_m_s_ = v_N;
  summed_ns_ = compass.stamp_ns;
}

}  // namespace fathom::study

#include "study/dead_reckoning.hpp"

#include <cmath>
#include <variant>

namespace fathom::study {

void DeadReckoning::take(const sim::Measurement& measurement) {
  if (const auto* dvl = std::get_if<DvlSample>(&measurement)) {
    const auto& v = dvl->velocity_D_m_s;
    if (known(v[0]) && known(v[1])) v_B_m_s_ = {v[0], v[1]};
  }
  if (const auto* compass = std::get_if<HeadingSample>(&measurement)) {
    if (known(compass->heading_rad)) turn(compass->header.stamp_ns, compass->heading_rad);
  }
}

void DeadReckoning::turn(TimeNs stamp_ns, double heading_rad) {
  const double sine = std::sin(heading_rad);
  const double cosine = std::cos(heading_rad);
  const Eigen::Vector2d v_N(cosine * v_B_m_s_.x() - sine * v_B_m_s_.y(),
                            sine * v_B_m_s_.x() + cosine * v_B_m_s_.y());
  if (started_) {
    const Eigen::Vector2d moved = 0.5 * to_seconds(stamp_ns - stamp_ns_) * (v_N_m_s_ + v_N);
    position_ = geo::moved_by(position_, {moved.x(), moved.y(), 0.0});
  }
  v_N_m_s_ = v_N;
  stamp_ns_ = stamp_ns;
  started_ = true;
}

}  // namespace fathom::study

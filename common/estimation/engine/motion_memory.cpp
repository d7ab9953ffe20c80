#include "estimation/engine/motion_memory.hpp"

#include <cmath>

namespace fathom::estimation {
namespace {

constexpr double kMoving_m_s = 0.1;

}  // namespace

void MotionMemory::open(const Navigator& navigator) {
  begin_ns_ = navigator.now_ns();
  yaw_before_rad_ = geo::to_rpy(navigator.state().nav.q_NB).z();
  samples_ = 0;
  rate_sum_.setZero();
  force_sum_.setZero();
}

void MotionMemory::watch(const Navigator& navigator) {
  const TimeNs now = navigator.now_ns();
  if (!navigator.navigating() || now < begin_ns_ || now - begin_ns_ > 3 * kNsPerSecond) {
    if (!navigator.navigating() || begin_ns_ != 0) count_ = 0;
    open(navigator);
    return;
  }
  rate_sum_ += navigator.rate_B_rad_s();
  force_sum_ += navigator.force_B_m_s2();
  ++samples_;
  if (now - begin_ns_ < kNsPerSecond) return;
  const NavSolution& nav = navigator.state().nav;
  const Eigen::Vector3d rpy = geo::to_rpy(nav.q_NB);
  Second& one = seconds_[static_cast<std::size_t>(next_)];
  one.roll_rad = rpy.x();
  one.pitch_rad = rpy.y();
  one.turned_rad = geo::wrap_pi(rpy.z() - yaw_before_rad_);
  one.speed_m_s = std::hypot(nav.v_N_m_s.x(), nav.v_N_m_s.y());
  one.sink_m_s = nav.v_N_m_s.z();
  one.slip_rad = one.speed_m_s > kMoving_m_s
                     ? geo::wrap_pi(std::atan2(nav.v_N_m_s.y(), nav.v_N_m_s.x()) - rpy.z())
                     : 0.0;
  one.rate_B_rad_s = rate_sum_ / samples_;
  one.force_B_m_s2 = force_sum_ / samples_;
  next_ = (next_ + 1) % kSeconds;
  count_ = std::min(count_ + 1, kSeconds);
  open(navigator);
}

}  // namespace fathom::estimation

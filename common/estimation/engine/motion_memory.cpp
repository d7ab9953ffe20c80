#include "estimation/engine/motion_memory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::estimation {
namespace {

/// What is compared to find the present again in the past: a whole manoeuvre, its straight parts included.
constexpr int kCompared_s = 60;
/// A pattern that repeats sooner is a motion of waves or of control.
constexpr int kShortestPattern_s = 30;
/// Differences below a quarter of a degree are none; the oldest of those that are alike is taken.
constexpr double kAlike = 1.2;
constexpr double kNoDifference_rad = 0.0044;

/// Squared, without a dimension: tilt, turn within a second, and velocity as a share of the speed.
double difference(const MotionMemory::Second& a, const MotionMemory::Second& b) {
  const Eigen::Vector3d down_a = geo::to_matrix(a.q_NB).row(2);
  const Eigen::Vector3d down_b = geo::to_matrix(b.q_NB).row(2);
  const double speed_a = a.v_N_m_s.head<2>().norm();
  const double speed_b = b.v_N_m_s.head<2>().norm();
  const double scale = std::max({a.v_N_m_s.norm(), b.v_N_m_s.norm(), 1.0});
  const double along = (speed_a - speed_b) / scale;
  const double down = (a.v_N_m_s.z() - b.v_N_m_s.z()) / scale;
  return (down_a - down_b).squaredNorm() + (a.rate_B_rad_s - b.rate_B_rad_s).squaredNorm() + along * along +
         down * down;
}

}  // namespace

double turn_about_down_rad(const geo::Quaternion& from_NB, const geo::Quaternion& to_NB) {
  const Eigen::Matrix3d turn = geo::to_matrix(to_NB * geo::conjugate(from_NB));
  return std::atan2(turn(1, 0) - turn(0, 1), turn(0, 0) + turn(1, 1));
}

int MotionMemory::likely_next() const {
  const int compared = std::min(kCompared_s, count_ - kShortestPattern_s);
  if (compared < kShortestPattern_s) return 0;
  std::array<double, kSeconds> differences{};
  double least = std::numeric_limits<double>::infinity();
  const int last = count_ - kShortestPattern_s;
  for (int next = compared; next <= last; ++next) {
    double sum = 0.0;
    for (int i = 1; i <= compared; ++i) sum += difference(at(count_ - i), at(next - i));
    differences[static_cast<std::size_t>(next)] = sum / compared;
    least = std::min(least, sum / compared);
  }
  const double alike = kAlike * kAlike * least + kNoDifference_rad * kNoDifference_rad;
  for (int next = compared; next <= last; ++next)
    if (differences[static_cast<std::size_t>(next)] <= alike) return next;
  return 0;
}

void MotionMemory::add(const Second& second) {
  seconds_[static_cast<std::size_t>(next_)] = second;
  next_ = (next_ + 1) % kSeconds;
  count_ = std::min(count_ + 1, kSeconds);
}

void MotionMemory::open(const Navigator& navigator) {
  begin_ns_ = navigator.now_ns();
  open_ = {};
  half_over_ = false;
  samples_ = 0;
}

void MotionMemory::watch(const Navigator& navigator) {
  const TimeNs now = navigator.now_ns();
  if (!navigator.navigating() || now < begin_ns_ || now - begin_ns_ > 3 * kNsPerSecond) {
    if (!navigator.navigating() || begin_ns_ != 0) count_ = 0;
    open(navigator);
    return;
  }
  open_.rate_B_rad_s += navigator.rate_B_rad_s();
  open_.force_B_m_s2 += navigator.force_B_m_s2();
  ++samples_;
  if (!half_over_ && now - begin_ns_ >= kNsPerSecond / 2) {
    half_over_ = true;
    open_.q_NB = navigator.state().nav.q_NB;
    open_.v_N_m_s = navigator.state().nav.v_N_m_s;
  }
  if (now - begin_ns_ < kNsPerSecond) return;
  open_.rate_B_rad_s /= samples_;
  open_.force_B_m_s2 /= samples_;
  add(open_);
  open(navigator);
}

}  // namespace fathom::estimation

#include "estimation/alignment/velocity_window.hpp"

#include <algorithm>

namespace fathom::estimation {
namespace {

/// A window does not wait for longer for a velocity.
constexpr double kLongestSilence_s = 3.0;
/// Sums of intervals are not exact.
constexpr double kWindowRounding_s = 1e-3;

}  // namespace

void InertialSpan::add(double dt_s, const Eigen::Vector3d& rate_B_rad_s,
                       const Eigen::Vector3d& force_B_m_s2) {
  // (ALN-6)
  const Eigen::Matrix3d c = geo::to_matrix(q_start_now * geo::exp(0.5 * dt_s * rate_B_rad_s));
  const Eigen::Vector3d force_start = c * force_B_m_s2;
  dv_by_gyro_bias -= dt_s * geo::skew(force_start) * (turn_by_bias + 0.5 * dt_s * c);
  turn_by_bias += dt_s * c;
  by_accel_bias += dt_s * c;
  dv_m_s += dt_s * force_start;
  q_start_now = geo::normalized(q_start_now * geo::exp(dt_s * rate_B_rad_s));
  duration_s += dt_s;
}

void VelocityWindow::measured(TimeNs stamp_ns, const Eigen::Vector3d& v_N_m_s,
                              const Eigen::Vector3d& sigma_m_s) {
  if (open_ && to_seconds(stamp_ns - measured_ns_) > kLongestSilence_s) reset();
  pending_ = true;
  measured_ns_ = stamp_ns;
  pending_v_N_m_s_ = v_N_m_s;
  pending_sigma_m_s_ = sigma_m_s;
}

std::optional<NewVelocity> VelocityWindow::pending() const {
  if (!pending_) return std::nullopt;
  return NewVelocity{measured_ns_, pending_v_N_m_s_, pending_sigma_m_s_};
}

void VelocityWindow::add(TimeNs now_ns, double dt_s, const Eigen::Vector3d& rate_B_rad_s,
                         const Eigen::Vector3d& force_B_m_s2, double length_s) {
  if (complete_) {
    // Nobody began with it: the next velocity opens another one.
    open_ = complete_ = has_middle_ = false;
  }
  double rest_s = dt_s;
  if (pending_) {
    pending_ = false;
    rest_s = std::clamp(to_seconds(now_ns - measured_ns_), 0.0, dt_s);
    if (open_) now_.add(dt_s - rest_s, rate_B_rad_s, force_B_m_s2);
    mark(rate_B_rad_s, length_s);
  }
  if (open_) now_.add(rest_s, rate_B_rad_s, force_B_m_s2);
}

void VelocityWindow::mark(const Eigen::Vector3d& rate_B_rad_s, double length_s) {
  if (!open_) {
    now_ = InertialSpan();
    open_ = true;
    first_ = {pending_v_N_m_s_, pending_sigma_m_s_, rate_B_rad_s, now_};
    return;
  }
  last_ = {pending_v_N_m_s_, pending_sigma_m_s_, rate_B_rad_s, now_};
  complete_ = now_.duration_s >= length_s - kWindowRounding_s;
  if (!complete_ && !has_middle_ && now_.duration_s >= 0.4 * length_s - kWindowRounding_s) {
    middle_ = last_;
    has_middle_ = true;
  }
}

}  // namespace fathom::estimation

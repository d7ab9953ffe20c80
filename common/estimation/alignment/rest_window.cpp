#include "estimation/alignment/rest_window.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::estimation {
namespace {

// The unrest of a floating vehicle is correlated over about this long: samples nearer together than this do
// not make the mean better.
constexpr double kUnrestTime_s = 1.0;

Eigen::Vector3d variance(const Eigen::Vector3d& sum, const Eigen::Vector3d& square, int count) {
  const double n = std::max(count, 1);
  return (square / n - (sum / n).cwiseAbs2()).cwiseMax(0.0);
}

}  // namespace

void RestWindow::add(double dt_s, const Eigen::Vector3d& rate_B_rad_s, const Eigen::Vector3d& force_B_m_s2) {
  // (ALN-1)
  const geo::Quaternion middle = q_start_now_ * geo::exp(0.5 * dt_s * rate_B_rad_s);
  const Eigen::Vector3d force_start = geo::to_matrix(middle) * force_B_m_s2;
  if (count_ == 0) force_first_ = force_start;
  q_start_now_ = geo::normalized(q_start_now_ * geo::exp(dt_s * rate_B_rad_s));
  duration_s_ += dt_s;
  ++count_;
  rate_sum_ += rate_B_rad_s;
  rate_square_ += rate_B_rad_s.cwiseAbs2();
  const Eigen::Vector3d excess = force_start - force_first_;
  force_sum_ += excess;
  force_square_ += excess.cwiseAbs2();
  const Eigen::Vector3d turn = geo::log(q_start_now_);
  turn_sum_ += turn;
  turn_square_ += turn.cwiseAbs2();
  time_sum_ += duration_s_;
  time_square_ += duration_s_ * duration_s_;
  turn_time_ += duration_s_ * turn;
}

void RestWindow::add_heading(double heading_rad, double sigma_rad, bool two_antenna) {
  if (two_antenna_ && !two_antenna) return;
  if (two_antenna && !two_antenna_) {
    heading_sine_ = heading_cosine_ = heading_sigma_rad_ = 0.0;
    headings_ = 0;
    two_antenna_ = true;
  }
  heading_sigma_rad_ = std::max(heading_sigma_rad_, sigma_rad);
  const double start = heading_rad - geo::to_rpy(q_start_now_).z();
  heading_sine_ += std::sin(start);
  heading_cosine_ += std::cos(start);
  ++headings_;
}

double RestWindow::rate_spread_rad_s() const {
  return std::sqrt(variance(rate_sum_, rate_square_, count_).maxCoeff());
}

double RestWindow::force_spread_m_s2() const {
  return std::sqrt(variance(force_sum_, force_square_, count_).maxCoeff());
}

double RestWindow::heading_start_rad() const {
  return std::atan2(heading_sine_, heading_cosine_);
}

RestResult RestWindow::result() const {
  RestResult out;
  out.duration_s = duration_s_;
  if (count_ == 0) return out;
  out.force_start_m_s2 = force_first_ + force_sum_ / count_;
  out.q_start_now = q_start_now_;
  out.mean_rate_B_rad_s = geo::log(q_start_now_) / duration_s_;
  const double shrink = std::sqrt(std::min(1.0, kUnrestTime_s / duration_s_));
  out.tilt_sigma_rad = std::sqrt(variance(force_sum_, force_square_, count_).maxCoeff()) * shrink /
                       out.force_start_m_s2.norm();
  // A swinging vehicle ends the window elsewhere than it began: that is what spoils the mean rate. The steady
  // turn with the Earth is no unrest, it is what is measured.
  const double n = count_;
  const double time_variance = time_square_ / n - std::pow(time_sum_ / n, 2);
  Eigen::Vector3d swing = variance(turn_sum_, turn_square_, count_);
  if (time_variance > 0.0) {
    const Eigen::Vector3d covariance = turn_time_ / n - (time_sum_ / n) * (turn_sum_ / n);
    swing = (swing - covariance.cwiseAbs2() / time_variance).cwiseMax(0.0);
  }
  out.rate_sigma_rad_s = 2.0 * swing.cwiseSqrt() / duration_s_;
  return out;
}

Eigen::Vector2d level(const Eigen::Vector3d& f) {
  // (ALN-2)
  return {std::atan2(-f.y(), -f.z()), std::atan2(f.x(), std::hypot(f.y(), f.z()))};
}

double gyrocompass(const Eigen::Vector2d& roll_pitch, const Eigen::Vector3d& rate_B_rad_s) {
  // (ALN-3): in levelled axes the horizontal part of the Earth's rate points north.
  const Eigen::Matrix3d to_level =
      geo::to_matrix(geo::from_rpy(Eigen::Vector3d(roll_pitch.x(), roll_pitch.y(), 0.0)));
  const Eigen::Vector3d rate = to_level * rate_B_rad_s;
  return std::atan2(-rate.y(), rate.x());
}

}  // namespace fathom::estimation

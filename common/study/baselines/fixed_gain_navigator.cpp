#include "study/baselines/fixed_gain_navigator.hpp"

#include <cmath>

#include <Eigen/Cholesky>

namespace fathom::study::fixed_gain {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// The transients of the start are no corrections of anything that lasts.
constexpr double kSettled_s = 30.0;

Matrix3d north_east_down_of(double latitude_rad, double longitude_rad) {
  const double sl = std::sin(latitude_rad);
  const double cl = std::cos(latitude_rad);
  const double so = std::sin(longitude_rad);
  const double co = std::cos(longitude_rad);
  Matrix3d rows;
  rows << -sl * co, -sl * so, cl, -so, co, 0.0, -cl * co, -cl * so, -sl;
  return rows;
}

Vector3d earth_centred(const geo::Geodetic& at) {
  const double sine = std::sin(at.latitude_rad);
  const geo::Radii radii = geo::radii(at.latitude_rad);
  const double level = (radii.normal_m + at.altitude_m) * std::cos(at.latitude_rad);
  return {level * std::cos(at.longitude_rad), level * std::sin(at.longitude_rad),
          (radii.normal_m * (1.0 - geo::kEccentricitySquared) + at.altitude_m) * sine};
}

geo::Geodetic place_of(const InitialState& start) {
  return {start.latitude_rad, start.longitude_rad, start.altitude_m};
}

}  // namespace

TangentFrame::TangentFrame(const geo::Geodetic& origin)
    : origin_E_m_(earth_centred(origin)),
      R_TE_(north_east_down_of(origin.latitude_rad, origin.longitude_rad)) {}

Vector3d TangentFrame::position_T_m(const geo::Geodetic& at) const {
  return R_TE_ * (earth_centred(at) - origin_E_m_);
}

Matrix3d TangentFrame::R_TN(const geo::Geodetic& at) const {
  return R_TE_ * north_east_down_of(at.latitude_rad, at.longitude_rad).transpose();
}

Navigator::Navigator(const Config& config, const InitialState& start)
    : config_(config), origin_(place_of(start)), frame_(origin_), start_ns_(start.stamp_ns) {
  q_IB_ = geo::from_rpy(geo::vec(start.rpy_rad));
  p_T_m_s_ = geo::vec(start.velocity_N_m_s);  // r is zero at the origin
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    covariance_(i, i) = start.attitude_sigma_rad[axis] * start.attitude_sigma_rad[axis];
    covariance_(3 + i, 3 + i) = start.position_sigma_N_m[axis] * start.position_sigma_N_m[axis];
    covariance_(6 + i, 6 + i) = start.velocity_sigma_N_m_s[axis] * start.velocity_sigma_N_m_s[axis];
  }
}

Matrix3d Navigator::R_TB() const {
  return inertial_to_tangent(origin_.latitude_rad, since_start_s_) * geo::to_matrix(q_IB_);
}

Navigator::Feedback Navigator::of_errors() const {
  // (FIX-4)
  const Gains& gains = config_.gains;
  return {gains.position_1_s2 * errors_.segment<3>(3) + gains.velocity_1_s * errors_.tail<3>(),
          gains.attitude_1_s * errors_.head<3>()};
}

void Navigator::add(const ImuSample& sample) {
  const Vector3d rate = geo::vec(sample.angular_rate_B_rad_s);
  const Vector3d force = geo::vec(sample.specific_force_B_m_s2);
  const TimeNs stamp_ns = sample.header.stamp_ns;
  if (running_) {
    step(0.5 * (rate_B_ + rate), 0.5 * (force_B_ + force), to_seconds(stamp_ns - now_ns_));
  } else if (stamp_ns >= start_ns_) {
    running_ = true;
    fix_ns_ = stamp_ns;
  }
  now_ns_ = stamp_ns;
  rate_B_ = rate;
  force_B_ = force;
  if (running_ && has_waiting_ && waiting_.header.stamp_ns <= now_ns_) {
    has_waiting_ = false;
    correct(waiting_);
  }
}

void Navigator::add(const GpsSample& sample) {
  if (sample.fix < GpsFix::fix_3d) return;
  waiting_ = sample;
  has_waiting_ = true;
}

void Navigator::step(const Vector3d& rate_B_rad_s, const Vector3d& force_B_m_s2, double dt_s) {
  // (FIX-5)
  const bool lost = to_seconds(now_ns_ - fix_ns_) > config_.lost_after_s;
  Feedback feedback = of_errors();
  if (lost) {
    feedback = config_.outage == OutageMode::mean ? mean_ : held_;
  } else if (since_start_s_ > kSettled_s) {
    averaged_s_ += dt_s;
    const double share = dt_s / averaged_s_;
    mean_.acceleration_T_m_s2 += share * (feedback.acceleration_T_m_s2 - mean_.acceleration_T_m_s2);
    mean_.rate_T_rad_s += share * (feedback.rate_T_rad_s - mean_.rate_T_rad_s);
  }

  const double latitude = origin_.latitude_rad;
  const Vector3d u_T = geo::earth_rate_N(latitude);
  const Matrix3d a = inertial_to_tangent(latitude, since_start_s_);
  // Half the turn before the force, which is that of the middle of the step.
  const geo::Quaternion half = geo::exp(0.5 * dt_s * rate_B_rad_s);
  const geo::Quaternion push = geo::exp(dt_s * (a.transpose() * feedback.rate_T_rad_s));
  const geo::Quaternion middle = q_IB_ * half;
  const Vector3d f_T = a * geo::to_matrix(middle) * force_B_m_s2;
  q_IB_ = geo::normalized(push * (middle * half));

  const geo::Radii radii = geo::radii(latitude);
  const double radius = std::sqrt(radii.meridian_m * radii.normal_m) + origin_.altitude_m;
  const double gravity = geo::gravity(latitude, origin_.altitude_m - r_T_m_.z());
  const Vector3d g_T = gravity * Vector3d(-r_T_m_.x() / radius, -r_T_m_.y() / radius, 1.0);
  const Vector3d p_dot = f_T + g_T - geo::cross(u_T, p_T_m_s_) + feedback.acceleration_T_m_s2;
  const Vector3d r_dot = p_T_m_s_ - geo::cross(u_T, r_T_m_);
  r_T_m_ += dt_s * r_dot + 0.5 * dt_s * dt_s * p_dot;
  p_T_m_s_ += dt_s * p_dot;
  since_start_s_ += dt_s;

  const Matrix9 phi = transition(latitude, dt_s, f_T);
  errors_ = (phi * errors_).eval();
  if (!lost) {
    errors_.head<3>() -= dt_s * feedback.rate_T_rad_s;
    errors_.segment<3>(3) -= 0.5 * dt_s * dt_s * feedback.acceleration_T_m_s2;
    errors_.tail<3>() -= dt_s * feedback.acceleration_T_m_s2;
  }
  covariance_ = (phi * covariance_ * phi.transpose()).eval();
  const double angle = config_.angle_walk_rad_sqrt_s * config_.angle_walk_rad_sqrt_s * dt_s;
  const double speed = config_.velocity_walk_m_s_sqrt_s * config_.velocity_walk_m_s_sqrt_s * dt_s;
  for (int i = 0; i < 3; ++i) {
    covariance_(i, i) += angle;
    covariance_(6 + i, 6 + i) += speed;
  }
}

void Navigator::correct(const GpsSample& fix) {
  const geo::Geodetic at{fix.latitude_rad, fix.longitude_rad, fix.altitude_m};
  const Vector3d u_T = geo::earth_rate_N(origin_.latitude_rad);
  const Vector3d lever_T = R_TB() * geo::vec(config_.gps_lever_B_m);
  const Vector3d swing_T = R_TB() * geo::cross(rate_B_, geo::vec(config_.gps_lever_B_m));
  const Vector3d r_gps = frame_.position_T_m(at) - lever_T;
  const Vector3d v_gps = frame_.R_TN(at) * geo::vec(fix.velocity_N_m_s) - swing_T;
  Eigen::Matrix<double, 6, 1> z;
  z << r_gps - r_T_m_, v_gps + geo::cross(u_T, r_gps) - p_T_m_s_;
  z -= errors_.tail<6>();
  Eigen::Matrix<double, 6, 6> s = covariance_.bottomRightCorner<6, 6>();
  for (int i = 0; i < 3; ++i) {
    s(i, i) += config_.position_sigma_m * config_.position_sigma_m;
    s(3 + i, 3 + i) += config_.velocity_sigma_m_s * config_.velocity_sigma_m_s;
  }
  const Eigen::Matrix<double, 6, 9> gain = s.llt().solve(covariance_.bottomRows<6>());
  errors_ += gain.transpose() * z;
  covariance_ -= (gain.transpose() * covariance_.bottomRows<6>()).eval();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  fix_ns_ = now_ns_;
  held_ = of_errors();
}

}  // namespace fathom::study::fixed_gain

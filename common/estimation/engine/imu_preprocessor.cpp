#include "estimation/engine/imu_preprocessor.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;

/// Intervals longer than this many nominal ones have lost samples in them.
constexpr double kLostFactor = 1.5;
/// Of the jitter that is remembered, from sample to sample: a clock that runs off by 0.7 % fills nothing in.
constexpr double kKept = 63.0 / 64.0;

bool finite(const Vector3d& v) {
  return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

}  // namespace

bool ImuPreprocessor::read(const ImuSample& sample) {
  const ImuConfig& imu = setup_->config.imu;
  const Vector3d angle = geo::vec(sample.delta_angle_B_rad);
  const Vector3d velocity = geo::vec(sample.delta_velocity_B_m_s);
  covered_s_ = 0.0;
  if (finite(angle) && finite(velocity) && sample.delta_time_s > 0.0 &&
      sample.delta_time_s < imu.lost_gap_s) {
    covered_s_ = sample.delta_time_s;
    rate_ = angle / covered_s_;
    force_ = velocity / covered_s_;
  } else {
    rate_ = geo::vec(sample.angular_rate_B_rad_s);
    force_ = geo::vec(sample.specific_force_B_m_s2);
  }
  if (!finite(rate_) || !finite(force_)) return false;
  if (rate_.cwiseAbs().maxCoeff() > imu.max_rate_rad_s) return false;
  if (force_.cwiseAbs().maxCoeff() > imu.max_specific_force_m_s2) return false;
  const Eigen::Matrix3d turn = geo::to_matrix(setup_->q_B_imu);
  rate_ = turn * rate_;
  force_ = turn * force_;
  return true;
}

double ImuPreprocessor::stretch_to_fill_s(double dt_s) {
  // The stamps jitter, the increments do not. A sample that is late looks as if one before it were lost; when
  // the next ones follow too soon, nothing was.
  uncovered_s_ = kKept * uncovered_s_ + dt_s - covered_s_;
  const double most_s = (kLostFactor - 1.0) * covered_s_;
  double fill_s = 0.0;
  if (uncovered_s_ > most_s) fill_s = uncovered_s_;
  if (uncovered_s_ < -most_s) fill_s = std::max(uncovered_s_, -filled_s_);
  uncovered_s_ -= fill_s;
  filled_s_ += fill_s;
  return fill_s;
}

ImuPreprocessor::Result ImuPreprocessor::take(const ImuSample& sample) {
  const ImuConfig& imu = setup_->config.imu;
  Result result;
  if (!sound_stamp(sample.header.stamp_ns)) return result;
  if (!read(sample)) {
    fault_ = ImuFault::not_finite;
    return result;
  }
  const TimeNs now = sample.header.stamp_ns;
  const auto settle = [&] {
    last_ns_ = now;
    last_received_ns_ = sample.header.received_ns;
    last_rate_ = rate_;
    last_force_ = force_;
    refused_in_a_row_ = 0;
    fault_ = ImuFault::none;
  };
  if (!started_) {
    started_ = true;
    settle();
    result.outcome = Outcome::first;
    return result;
  }
  const double dt = static_cast<double>(now - last_ns_) * 1e-9;
  if (now <= last_ns_ || dt > imu.lost_gap_s) {
    const bool follows = refused_in_a_row_ > 0 && now > refused_ns_ &&
                         static_cast<double>(now - refused_ns_) * 1e-9 <= imu.max_gap_s;
    refused_in_a_row_ = follows ? refused_in_a_row_ + 1 : 1;
    refused_ns_ = now;
    if (refused_in_a_row_ < kNewAxis) {
      fault_ = ImuFault::stale;
      result.refusal = now == last_ns_  ? VerdictKind::duplicate
                       : now < last_ns_ ? VerdictKind::late
                                        : VerdictKind::from_the_future;
      return result;
    }
    // The arrival clock tells how long the instrument was really silent, if anything does.
    const bool told = sound_stamp(sample.header.received_ns) && sound_stamp(last_received_ns_);
    const double silent = told ? to_seconds(sample.header.received_ns - last_received_ns_) : 0.0;
    result.unobserved_s = std::clamp(silent, 0.0, 1e6);
    has_before_ = false;
    uncovered_s_ = filled_s_ = 0.0;
    settle();
    result.outcome = Outcome::rebased;
    return result;
  }

  ImuStep& step = result.step;
  step.from_ns = last_ns_;
  step.to_ns = now;
  Increments& in = step.increments;
  in.dt_s = dt;
  const Vector3d rate_between = 0.5 * (last_rate_ + rate_);
  const Vector3d force_between = 0.5 * (last_force_ + force_);
  if (covered_s_ > 0.0) {
    const double missing = stretch_to_fill_s(dt);
    in.dtheta_rad = covered_s_ * rate_ + missing * rate_between;
    in.dv_m_s = covered_s_ * force_ + missing * force_between;
  } else {
    const bool between =
        imu.rate_convention == RateConvention::point || dt > kLostFactor / imu.nominal_rate_hz;
    in.dtheta_rad = dt * (between ? rate_between : rate_);
    in.dv_m_s = dt * (between ? force_between : force_);
  }
  in.dtheta_before_rad = has_before_ ? Vector3d(dt * mean_rate_before_) : in.dtheta_rad;
  in.dv_before_m_s = has_before_ ? Vector3d(dt * mean_force_before_) : in.dv_m_s;
  if (dt > imu.max_gap_s) step.gap_s = dt;
  step.fault = fault_;
  mean_rate_before_ = in.dtheta_rad / dt;
  mean_force_before_ = in.dv_m_s / dt;
  has_before_ = true;
  settle();
  result.outcome = Outcome::step;
  return result;
}

}  // namespace fathom::estimation

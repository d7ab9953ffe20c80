#include "estimation/alignment/drop_alignment.hpp"

#include <algorithm>
#include <cmath>

#include "geo/wgs84.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSlip_s = 0.1;  // interval of the slip model as a measurement
constexpr double kSlipNoise_m_s = 0.05;
constexpr double kSlipDoubt = 0.3;  // share of the slip in a turn
constexpr double kConsistency_s = 4.0;
constexpr double kConsistent = 2.0;  // limit of the mean normalised innovation squared
constexpr double kLimitSigma = 7.0;  // a single measurement further off is not taken
constexpr double kAgree_sigma = 4.0;
constexpr double kCoarseShown_s = 0.1;  // so that every reader sees each phase
constexpr double kLostShown_s = 1.0;    // less than any window takes
constexpr double kLagDoubt = 0.2;
constexpr double kLagTime_s = 0.5;
constexpr double kSlopeStart_m_s2 = 5.0;
constexpr double kSlopeNoise_m_s2 = 0.02;   // a second, of the thrust
constexpr double kSlopePerTurn_m_s2 = 2.0;  // weight and drag along x change with the pitch
constexpr double kTurning_s = 10.0;         // for which a wrong gyro axis turns the same way
constexpr double kFlowShare = 0.75;         // of the spread within a window that its mean may have

/// Roll, pitch and yaw per attitude error about N (OUT-1).
Matrix3d euler_slope(const geo::Quaternion& q) {
  const Vector3d rpy = geo::to_rpy(q);
  const double cosine = std::cos(rpy.z());
  const double sine = std::sin(rpy.z());
  const double level = std::max(std::abs(std::cos(rpy.y())), 1e-3);
  const double tangent = std::sin(rpy.y()) / level;
  Matrix3d j;
  j << -cosine / level, -sine / level, 0.0, sine, -cosine, 0.0, -cosine * tangent, -sine * tangent, -1.0;
  return j;
}

}  // namespace

void SpeedTrack::restart(double speed_m_s, double sigma_m_s) {
  x_ = {speed_m_s, 0.0};
  p_ = Eigen::Vector2d(sigma_m_s * sigma_m_s, kSlopeStart_m_s2 * kSlopeStart_m_s2).asDiagonal();
}

void SpeedTrack::add(double dt_s, double speed_m_s, double sigma_m_s, double tau_s, double rate_y_rad_s) {
  // (ALN-13)
  if (dt_s > 0.0) {
    const double keep = std::exp(-dt_s / tau_s);
    Eigen::Matrix2d phi;
    phi << 1.0, tau_s * (1.0 - keep), 0.0, keep;
    x_ = phi * x_;
    p_ = (phi * p_ * phi.transpose()).eval();
    const double turning = kSlopePerTurn_m_s2 * rate_y_rad_s;
    p_(1, 1) += dt_s * (kSlopeNoise_m_s2 * kSlopeNoise_m_s2 + turning * turning);
  }
  const double s = p_(0, 0) + sigma_m_s * sigma_m_s;
  const Vector2d k = p_.col(0) / s;
  x_ += k * (speed_m_s - x_.x());
  p_ = (p_ - k * k.transpose() * s).eval();
}

DropAlignment::DropAlignment(const DropConfig& config) : config_(config), gate_(config.stability) {}

void DropAlignment::enter(AlignmentPhase phase) {
  if (phase == phase_) return;
  phase_ = phase;
  phase_since_s_ = time_s_;
}

void DropAlignment::start(const geo::Quaternion& q_NB) {
  *this = DropAlignment(config_);
  q_NB_ = q_release_ = q_NB;
  release_heading_rad_ = geo::to_rpy(q_NB).z();
  const double tilt = config_.tilt_sigma_rad * config_.tilt_sigma_rad;
  covariance_ = Vector3d(tilt, tilt, config_.heading_sigma_rad * config_.heading_sigma_rad).asDiagonal();
  enter(AlignmentPhase::waiting);
}

void DropAlignment::lose() {
  const geo::Quaternion q = q_NB();
  start(q);
  enter(AlignmentPhase::lost);
}

void DropAlignment::widen(double angle_rad, double velocity_m_s, double depth_m) {
  config_.tilt_sigma_rad = std::hypot(config_.tilt_sigma_rad, angle_rad);
  config_.heading_sigma_rad = std::hypot(config_.heading_sigma_rad, angle_rad);
  covariance_.diagonal().array() += angle_rad * angle_rad;
  if (filtering_) filter_.widen(angle_rad, velocity_m_s, depth_m);
}

Vector3d DropAlignment::slip(const Vector3d& rate) const {
  // (TILT-5)
  const double u = std::max(measured_speed_m_s_, kLeastSpeed_m_s);
  const Matrix3d c = geo::to_matrix(q_NB());
  const Vector3d down_B = c.row(2).transpose();
  return {measured_speed_m_s_, -config_.slip_per_turn_m * rate.z() + config_.trim_m2_s2 * down_B.y() / u,
          config_.slip_per_turn_m * rate.y() + config_.trim_m2_s2 * down_B.z() / u};
}

void DropAlignment::start_filter(const Matrix3d& attitude) {
  TiltFilter::Matrix p = TiltFilter::Matrix::Zero();
  p.block<3, 3>(TiltFilter::kPhi, TiltFilter::kPhi) = attitude;
  const Matrix3d c = geo::to_matrix(q_NB_);
  const double u = measured_speed_m_s_;
  const auto square = [](double x) { return x * x; };
  const double flow = square(config_.flow_sigma_m_s);
  const double scale = square(config_.speed_scale_sigma);
  const double bias = square(config_.speed_bias_sigma_m_s);
  // The velocity comes from the log and the slip model: what is wrong with those is wrong with it, the other
  // way round.
  const Vector3d own(square(config_.speed_sigma_m_s), square(kSlipNoise_m_s), square(kSlipNoise_m_s));
  const Vector3d along = own + Vector3d(u * u * scale + bias, flow, flow);
  p.block<3, 3>(TiltFilter::kVelocity, TiltFilter::kVelocity) = c * along.asDiagonal() * c.transpose();
  const auto cross = [&](int state, const Vector3d& column_B) {
    p.block<3, 1>(TiltFilter::kVelocity, state) = c * column_B;
    p.block<1, 3>(state, TiltFilter::kVelocity) = (c * column_B).transpose();
  };
  cross(TiltFilter::kScale, {-u * scale, 0.0, 0.0});
  cross(TiltFilter::kLogBias, {-bias, 0.0, 0.0});
  cross(TiltFilter::kSideBias, {0.0, flow, 0.0});
  cross(TiltFilter::kHeaveBias, {0.0, 0.0, flow});
  p(TiltFilter::kDepth, TiltFilter::kDepth) = square(config_.depth_sigma_m);
  for (int i = 0; i < 3; ++i)
    p(TiltFilter::kAccel + i, TiltFilter::kAccel + i) = square(config_.accel_sigma_m_s2);
  p(TiltFilter::kScale, TiltFilter::kScale) = scale;
  p(TiltFilter::kLogBias, TiltFilter::kLogBias) = bias;
  p(TiltFilter::kSideBias, TiltFilter::kSideBias) = flow;
  p(TiltFilter::kHeaveBias, TiltFilter::kHeaveBias) = flow;
  filter_.start(q_NB_, c * slip(slip_rate_), depth_m_, p);
  filtering_ = true;
  behind_m_s_ = config_.speed_lag_s * speed_.slope_m_s2();
  filtering_since_s_ = time_s_;
  next_slip_s_ = time_s_ + kSlip_s;
  turned_ = geo::Quaternion();
  consistency_ = 1.0;
}

Vector3d DropAlignment::take(const TiltFilter::Row* rows, int count) {
  const TiltFilter::Result result = filter_.update(rows, count, kLimitSigma);
  const double each = (result.squared_distance + kLimitSigma * kLimitSigma * result.refused) / count;
  // Measurements that come often count less each, so that the memory is in seconds.
  const double gain = kSlip_s / kConsistency_s / 3.0;
  consistency_ += gain * (each - consistency_);
  const double slip = heading_slip(result.rotation_N_rad);
  filter_.turn_heading(-slip);
  turned_ = geo::normalized(geo::exp(result.rotation_N_rad) * turned_);
  return result.rotation_N_rad - Vector3d(0.0, 0.0, slip);
}

Vector3d DropAlignment::add(const DropStep& step) {
  // (ALN-12)
  time_s_ += step.dt_s > 0.0 ? step.dt_s : 0.0;
  g_m_s2_ = step.g_m_s2;
  Vector3d turned = Vector3d::Zero();
  const bool finite = step.rate_IB_B_rad_s.allFinite() && step.force_B_m_s2.allFinite();
  if (finite && step.dt_s > 0.0) {
    const Matrix3d c = geo::to_matrix(q_NB());
    rate_NB_B_ = step.rate_IB_B_rad_s - c.transpose() * step.rate_IN_N_rad_s;
    const double u = std::max(measured_speed_m_s_, kLeastSpeed_m_s);
    const double follow = 1.0 - std::exp(-step.dt_s * u / config_.flow_lag_m);
    slip_rate_ += follow * (rate_NB_B_ - slip_rate_);
    if (filtering_) {
      const Vector3d pull = Vector3d(0.0, 0.0, step.g_m_s2) -
                            geo::cross(step.rate_IN_N_rad_s + step.earth_rate_N_rad_s, filter_.v_N_m_s());
      const auto markov = [&](double tau_s) { return std::exp(-step.dt_s / tau_s); };
      TiltFilter::Vector keep = TiltFilter::Vector::Ones();
      TiltFilter::Vector noise = TiltFilter::Vector::Zero();
      const double gyro = step.dt_s * config_.gyro_noise_rad_sqrt_s * config_.gyro_noise_rad_sqrt_s;
      const double axes = config_.gyro_misalignment_rad * rate_NB_B_.norm();
      const double tilt = gyro + step.dt_s * kTurning_s * axes * axes;
      const double accel = std::max(config_.accel_noise_m_s_sqrt_s * config_.accel_noise_m_s_sqrt_s,
                                    gate_.jitter_m2_s4() * step.dt_s);
      noise.segment<3>(TiltFilter::kPhi).setConstant(tilt);
      // An attitude error turns the velocity that is carried on with it.
      noise.segment<3>(TiltFilter::kVelocity)
          .setConstant(step.dt_s * accel + tilt * filter_.v_N_m_s().squaredNorm());
      const auto bias = [&](int state, double sigma, double tau_s) {
        keep(state) = markov(tau_s);
        noise(state) = sigma * sigma * (1.0 - keep(state) * keep(state));
      };
      bias(TiltFilter::kLogBias, config_.speed_bias_sigma_m_s, config_.speed_bias_tau_s);
      bias(TiltFilter::kSideBias, config_.flow_sigma_m_s, config_.flow_tau_s);
      bias(TiltFilter::kHeaveBias, config_.flow_sigma_m_s, config_.flow_tau_s);
      const double before_m_s = filter_.forward_m_s();  // (TILT-6)
      filter_.predict(step.dt_s, rate_NB_B_, step.force_B_m_s2, pull, noise, keep);
      behind_m_s_ += filter_.forward_m_s() - before_m_s;
      behind_m_s_ *= config_.speed_lag_s > 0.0 ? std::exp(-step.dt_s / config_.speed_lag_s) : 0.0;
    } else {
      q_NB_ = geo::normalized(q_NB_ * geo::exp(step.dt_s * rate_NB_B_));
    }
  }
  follow_level(step);
  if (filtering_ && time_s_ >= next_slip_s_ && fresh(speed_at_s_)) {
    next_slip_s_ = std::max(next_slip_s_ + kSlip_s, time_s_);  // what a gap has skipped is not made up for
    const Vector3d model = slip(slip_rate_);
    // The model is that of a steady turn: the faster it turns, the less it knows.
    const Vector3d doubt = kSlipDoubt * config_.slip_per_turn_m * slip_rate_;
    const TiltFilter::Row rows[] = {filter_.side_row(model.y(), std::hypot(kSlipNoise_m_s, doubt.z())),
                                    filter_.heave_row(model.z(), std::hypot(kSlipNoise_m_s, doubt.y()))};
    turned += take(rows, 2);
    recentre();
    if (captured()) turned += restart_from_level();
  }
  if (!filtering_ && config_.fine && config_.early && wet() && time_s_ - entered_s_ >= config_.fine_delay_s &&
      fresh(speed_at_s_) && fresh(depth_at_s_) && measured_speed_m_s_ > kLeastSpeed_m_s)
    start_filter(covariance_);

  StabilityInput in;
  in.dt_s = step.dt_s;
  const Vector3d rpy = geo::to_rpy(q_NB());
  in.roll_rad = rpy.x();
  in.pitch_rad = rpy.y();
  if (fresh(depth_at_s_)) in.depth_error_m = config_.set_depth_m - depth_m_;
  if (fresh(speed_at_s_)) {
    in.speed_m_s = speed_.speed_m_s();
    in.speed_slope_m_s2 = speed_.slope_m_s2();
  }
  in.rate_B_rad_s = step.rate_IB_B_rad_s;
  in.force_B_m_s2 = step.force_B_m_s2;
  in.g_m_s2 = step.g_m_s2;
  const bool searching =
      phase_ != AlignmentPhase::coarse && phase_ != AlignmentPhase::fine && phase_ != AlignmentPhase::aligned;
  const StabilityGate::Phase found = gate_.add(in);
  if (searching) {
    const bool late = wet() && time_s_ - entered_s_ > config_.timeout_s;
    if (found == StabilityGate::Phase::full) {
      turned += finish_window();
    } else if (late) {
      enter(AlignmentPhase::timed_out);
    } else if (phase_ != AlignmentPhase::lost || in_phase_s() >= kLostShown_s) {
      enter(found == StabilityGate::Phase::averaging ? AlignmentPhase::averaging : AlignmentPhase::waiting);
    }
  }
  watch();
  return turned;
}

Vector3d DropAlignment::add_depth(double depth_m) {
  if (!std::isfinite(depth_m)) return Vector3d::Zero();
  depth_m_ = depth_m;
  depth_at_s_ = time_s_;
  if (!wet() && depth_m > config_.wet_depth_m) entered_s_ = time_s_;
  if (!filtering_) return Vector3d::Zero();
  const TiltFilter::Row row = filter_.depth_row(depth_m, config_.depth_sigma_m);
  return take(&row, 1);
}

Vector3d DropAlignment::add_rpm(double rpm) {
  const double speed = config_.speed_per_rpm * rpm;
  if (!std::isfinite(speed)) return Vector3d::Zero();
  const double dt_s = speed_at_s_ < 0.0 ? 1e9 : time_s_ - speed_at_s_;
  measured_speed_m_s_ = speed;
  speed_at_s_ = time_s_;
  if (dt_s > config_.sensor_timeout_s) {
    speed_.restart(speed, config_.speed_sigma_m_s);
  } else {
    speed_.add(dt_s, speed, config_.speed_sigma_m_s, config_.surge_tau_s, rate_NB_B_.y());
  }
  if (!filtering_ || speed < kLeastSpeed_m_s) return Vector3d::Zero();
  // The lag is known to a share only, and what is wrong with it is wrong for a while: readings that come
  // often count less each.
  const double lag = kLagDoubt * behind_m_s_;
  const double often = std::max(1.0, kLagTime_s / std::max(dt_s, 1e-3));
  const double sigma = std::sqrt(config_.speed_sigma_m_s * config_.speed_sigma_m_s + often * lag * lag);
  const TiltFilter::Row row = filter_.speed_row(speed + behind_m_s_, sigma);
  return take(&row, 1);
}

Vector2d DropAlignment::coarse_sigma(const StabilityWindow& window) const {
  // (ALN-12) Accelerometers; the flow that pushed the vehicle during the window; the slope of the speed.
  const double noise = gate_.jitter_m2_s4() / std::max(window.samples, 1);
  const double accel = std::sqrt(config_.accel_sigma_m_s2 * config_.accel_sigma_m_s2 + noise);
  const double flow = kFlowShare * window.flow_spread_m_s2;
  // The printed form takes the whole slope for pitch, and knows that it does.
  const double neglected = config_.form == DropConfig::Form::printed ? window.speed_slope_m_s2 : 0.0;
  const double slope = std::hypot(speed_.slope_sigma_m_s2(), neglected);
  return Vector2d(std::hypot(accel, flow), std::hypot(accel, slope)) / g_m_s2_;
}

Vector3d DropAlignment::finish_window() {
  const StabilityWindow& window = gate_.window();
  // The slope is known best at the end of the window; it has died away since its middle.
  const double half = 0.5 * config_.stability.window_s / config_.surge_tau_s;
  const double slope = speed_.slope_m_s2() * std::exp(half) * std::sinh(half) / half;
  const Vector3d v(window.speed_m_s, -config_.slip_per_turn_m * window.rate_B_rad_s.z(),
                   config_.slip_per_turn_m * window.rate_B_rad_s.y() +
                       config_.trim_m2_s2 / std::max(window.speed_m_s, kLeastSpeed_m_s));
  const MotionLevel found =
      config_.form == DropConfig::Form::printed
          ? level_printed(window.force_B_m_s2, window.rate_B_rad_s.z(), window.speed_m_s, g_m_s2_)
          : level_in_motion(window.force_B_m_s2, {slope, 0.0, 0.0}, window.rate_B_rad_s, v);
  if (found.fault != LevelFault::none) {
    gate_.reset(StabilityReset::level);
    enter(AlignmentPhase::waiting);
    return Vector3d::Zero();
  }
  const Vector2d sigma = coarse_sigma(window);
  const Vector2d error(window.roll_rad - found.roll_rad, window.pitch_rad - found.pitch_rad);
  if (filtering_) {
    // The early filter has used the same accelerometers: the window confirms it, or neither is believed.
    const Vector3d own = rpy_sigma_rad();
    if (std::abs(error.x()) > kAgree_sigma * std::hypot(own.x(), sigma.x()) ||
        std::abs(error.y()) > kAgree_sigma * std::hypot(own.y(), sigma.y())) {
      gate_.reset(StabilityReset::disagreement);
      enter(AlignmentPhase::waiting);
      return Vector3d::Zero();
    }
    enter(AlignmentPhase::coarse);
    return Vector3d::Zero();
  }
  const Vector3d rpy = geo::to_rpy(q_NB_);
  const geo::Quaternion corrected = geo::from_rpy({rpy.x() - error.x(), rpy.y() - error.y(), rpy.z()});
  Vector3d turned = geo::log(corrected * geo::conjugate(q_NB_));
  q_NB_ = corrected;
  heading_slip(turned);  // the heading of now is kept, not that of the release
  // Heading errors do not mix with those of roll and pitch in a level run.
  const double heading = config_.heading_sigma_rad;
  const Matrix3d to_N = geo::to_matrix(geo::from_rpy({0.0, 0.0, rpy.z()}));
  covariance_ = to_N *
                Vector3d(sigma.x() * sigma.x(), sigma.y() * sigma.y(), heading * heading).asDiagonal() *
                to_N.transpose();
  enter(AlignmentPhase::coarse);
  if (config_.fine) start_filter(covariance_);
  return turned;
}

void DropAlignment::watch() {
  if (!filtering_) return;
  const Vector3d sigma = rpy_sigma_rad();
  const bool aligned = phase_ == AlignmentPhase::aligned;
  const double limit = config_.aligned_tilt_sigma_rad * (aligned ? 2.0 : 1.0);
  const bool good = sigma.x() <= limit && sigma.y() <= limit && consistent();
  if (!good) {
    hold_since_s_ = -1.0;
    if (aligned) enter(AlignmentPhase::fine);
    if (phase_ == AlignmentPhase::coarse && in_phase_s() >= kCoarseShown_s) enter(AlignmentPhase::fine);
    return;
  }
  if (hold_since_s_ < 0.0) hold_since_s_ = time_s_;
  if (phase_ == AlignmentPhase::coarse) {
    if (in_phase_s() >= kCoarseShown_s) enter(AlignmentPhase::fine);
    return;
  }
  const bool alone = time_s_ - filtering_since_s_ >= config_.alone_s;
  if (phase_ != AlignmentPhase::fine && !aligned && !alone) return;
  if (phase_ != AlignmentPhase::fine && !aligned) enter(AlignmentPhase::fine);
  // The hold is that of the phase, so that fine is seen before aligned.
  if (held_s() >= config_.aligned_hold_s && in_phase_s() >= config_.aligned_hold_s)
    enter(AlignmentPhase::aligned);
}

bool DropAlignment::consistent() const {
  return consistency_ <= kConsistent;
}

StabilityReset DropAlignment::missing() const {
  if (!fresh(depth_at_s_)) return StabilityReset::no_depth;
  if (!fresh(speed_at_s_)) return StabilityReset::no_speed;
  return StabilityReset::none;
}

Matrix3d DropAlignment::attitude_covariance() const {
  return filtering_ ? Matrix3d(filter_.covariance().block<3, 3>(TiltFilter::kPhi, TiltFilter::kPhi))
                    : covariance_;
}

Vector3d DropAlignment::rpy_sigma_rad() const {
  const Matrix3d j = euler_slope(q_NB());
  return (j * attitude_covariance() * j.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

double DropAlignment::time_to_aligned_s() const {
  if (phase_ == AlignmentPhase::aligned) return 0.0;
  if (phase_ == AlignmentPhase::fine || phase_ == AlignmentPhase::coarse)
    return hold_since_s_ < 0.0 ? kUnknown : std::max(0.0, config_.aligned_hold_s - in_phase_s());
  if (!wet() || phase_ == AlignmentPhase::timed_out || !fresh(depth_at_s_) || !fresh(speed_at_s_))
    return kUnknown;
  return gate_.time_to_full_s() + config_.aligned_hold_s;
}

}  // namespace fathom::estimation

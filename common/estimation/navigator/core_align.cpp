#include <algorithm>
#include <cmath>

#include "estimation/aiding/gps_position.hpp"
#include "estimation/aiding/heading.hpp"
#include "estimation/navigator/core.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFreshFix_s = 5.0;
constexpr double kLeastWindow_s = 0.5;
constexpr int kFastFixes = 2;
constexpr double kWindowsKept = 4.0;

}  // namespace

void Core::enter(AlignmentPhase phase) {
  if (phase == phase_) return;
  phase_ = phase;
  phase_since_ns_ = now_ns_;
}

/// Remembers what a start needs; called for every measurement that is not refused outright.
void Core::notice(const Measurement& measurement) {
  const SensorConfig& config = setup_->config.sensors[static_cast<std::size_t>(measurement.sensor)];
  if (const auto* gps = std::get_if<GpsSample>(&measurement.sample)) {
    if (!is_fixed(config, *gps)) return;
    if (!std::isfinite(gps->latitude_rad) || !std::isfinite(gps->longitude_rad)) return;
    if (std::abs(gps->latitude_rad) > 1.5708 || std::abs(gps->longitude_rad) > 6.2832) return;
    Vector3d v = geo::vec(gps->velocity_N_m_s);
    if (!std::isfinite(v.x()) || !std::isfinite(v.y())) v.head<2>().setConstant(kUnknown);
    const double speed = std::hypot(v.x(), v.y());
    gps_speed_m_s_ = speed;
    const bool fast = speed > setup_->config.alignment.in_motion_speed_m_s && speed < 1000.0;
    fast_fixes_ = fast ? fast_fixes_ + 1 : 0;
    gps_seen_ns_ = now_ns_;
    const bool high = std::abs(gps->altitude_m) < 5e4;  // false where it is unknown
    gps_position_ = {gps->latitude_rad, gps->longitude_rad, high ? gps->altitude_m : 0.0};
    gps_velocity_N_ = {v.x(), v.y(), std::isfinite(v.z()) ? v.z() : 0.0};
    for (std::size_t i = 0; i < 3; ++i) {
      const double sigma = sigma_of(config.sigma[i], gps->position_sigma_N_m[i], config.use_sample_sigma);
      gps_sigma_N_m_(static_cast<int>(i)) = std::max(sigma, setup_->config.alignment.position_sigma_m);
    }
    if (!high) gps_sigma_N_m_.z() = 200.0;
    return;
  }
  if (navigating_) return;
  notice_under_way(measurement, config);
  if (const auto* heading = std::get_if<HeadingSample>(&measurement.sample)) {
    const double variation =
        setup_->config.magnetic_variation_known ? setup_->config.magnetic_variation_rad : kUnknown;
    const double psi = true_heading(*heading, variation) - config.mounting_rpy_rad[2];
    const AlignmentConfig& alignment = setup_->config.alignment;
    if (std::abs(psi) < 20.0 && window_.duration_s() > 0.0 && heading_wanted(alignment, config))
      window_.add_heading(psi, heading_sigma(alignment, config, *heading), config.two_antenna);
  }
}

bool Core::waits_for_state() const {
  const StartMode mode = setup_->config.alignment.mode;
  return mode == StartMode::given || (mode == StartMode::air_drop && !released_);
}

StartConditions Core::conditions() const {
  const AlignmentConfig& config = setup_->config.alignment;
  StartConditions c;
  c.window_full = window_.duration_s() >= config.averaging_s;
  c.quiet = window_.rate_spread_rad_s() <= config.rate_spread_rad_s &&
            window_.force_spread_m_s2() <= config.force_spread_m_s2;
  // Without a fresh speed there is nothing to say against rest.
  c.slow = !(since(gps_seen_ns_) <= kFreshFix_s && gps_speed_m_s_ > config.max_speed_m_s);
  c.heading = config.heading_source == HeadingSource::given ||
              config.heading_source == HeadingSource::gyrocompass || window_.headings() > 0;
  c.position = start_position().has_value();
  return c;
}

std::optional<geo::Geodetic> Core::start_position() const {
  const AlignmentConfig& config = setup_->config.alignment;
  if (since(gps_seen_ns_) <= kFreshFix_s) return gps_position_;
  if (position_set_) return set_position_;
  if (config.position_given)
    return geo::Geodetic{config.given_latitude_rad, config.given_longitude_rad, config.given_altitude_m};
  return std::nullopt;
}

void Core::align(const ImuStep& step) {
  const AlignmentConfig& config = setup_->config.alignment;
  const Increments& in = step.increments;
  if (phase_ == AlignmentPhase::none) {
    enter(AlignmentPhase::waiting);
    waiting_since_ns_ = now_ns_;
  }
  if (waits_for_state() || in.dt_s <= 0.0) return;

  const Vector3d force = in.dv_m_s / in.dt_s;
  const double keep = std::exp(-in.dt_s / config.in_motion_averaging_s);
  smooth_force_ = smooth_time_s_ > 0.0 ? Vector3d(keep * smooth_force_ + (1.0 - keep) * force) : force;
  smooth_time_s_ += in.dt_s;
  const bool may_move = config.mode != StartMode::at_rest;
  // A dropped vehicle that only runs smoothly is not at rest: GPS has to say so.
  const bool may_rest =
      config.mode != StartMode::in_motion && (!released_ || since(gps_seen_ns_) <= kFreshFix_s);
  const bool late = to_seconds(now_ns_ - waiting_since_ns_) > config.timeout_s;

  if (may_move && fast_fixes_ >= kFastFixes && since(gps_seen_ns_) <= 1.0 &&
      smooth_time_s_ >= config.in_motion_averaging_s) {
    start_in_motion();
    return;
  }
  if (may_move && can_start_under_way()) {
    start_under_way();
    return;
  }
  if (!may_rest) {
    if (late) enter(AlignmentPhase::timed_out);
    return;
  }
  window_.add(in.dt_s, in.dtheta_rad / in.dt_s, force);
  const StartConditions c = conditions();
  const bool judged = window_.duration_s() >= kLeastWindow_s;
  if (!c.slow || (judged && !c.quiet) || window_.duration_s() > kWindowsKept * config.averaging_s) {
    window_.reset();
    levelled_ = levelled_ && c.slow && c.quiet;
    enter(late ? AlignmentPhase::timed_out : AlignmentPhase::waiting);
    return;
  }
  if (!c.window_full) {
    if (judged) enter(late ? AlignmentPhase::timed_out : AlignmentPhase::averaging);
    return;
  }
  levelled_ = true;
  const RestResult rest = window_.result();
  const Eigen::Vector2d tilt = level(rest.force_start_m_s2);
  state_.nav.q_NB = geo::from_rpy(Vector3d(tilt.x(), tilt.y(), 0.0)) * rest.q_start_now;
  enter(late ? AlignmentPhase::timed_out : AlignmentPhase::coarse);
  if (c.position) start_at_rest();
}

void Core::start_at_rest() {
  const AlignmentConfig& config = setup_->config.alignment;
  const ImuConfig& imu = setup_->config.imu;
  const StateIndex& index = setup_->index;
  const RestResult rest = window_.result();
  const geo::Geodetic position = *start_position();
  const Eigen::Vector2d tilt = level(rest.force_start_m_s2);
  const double rate_noise = std::hypot(rest.rate_sigma_rad_s.maxCoeff(),
                                       imu.angle_random_walk_rad_sqrt_s / std::sqrt(rest.duration_s));
  const double horizontal_earth_rate = geo::kEarthRate_rad_s * std::cos(position.latitude_rad);
  const double gyro_sigma = std::hypot(imu.gyro_bias_sigma_rad_s, rate_noise) / horizontal_earth_rate;

  double heading = 0.0;
  double heading_sigma = 0.0;
  bool from_gyro = false;
  const bool gyro_good = gyro_sigma <= config.gyrocompass_limit_rad;
  switch (config.heading_source) {
    case HeadingSource::given:
      heading = config.given_heading_rad;
      heading_sigma = config.given_heading_sigma_rad;
      break;
    case HeadingSource::gyrocompass:
      if (!gyro_good) return;
      from_gyro = true;
      break;
    case HeadingSource::compass:
    case HeadingSource::two_antenna:
    case HeadingSource::automatic:
      if (window_.headings() > 0) {
        heading = window_.heading_start_rad();
        heading_sigma = window_.heading_sigma_rad();
      } else if (config.heading_source == HeadingSource::automatic && gyro_good) {
        from_gyro = true;
      } else {
        return;
      }
      break;
  }
  if (from_gyro) {
    // (ALN-3)
    heading = gyrocompass(tilt, rest.mean_rate_B_rad_s);
    heading_sigma = gyro_sigma;
  }

  FilterState start;
  const geo::Quaternion q_start = geo::from_rpy(Vector3d(tilt.x(), tilt.y(), heading));
  // (ALN-18): the gyro turned the axes back against the stars, and N has turned with the Earth since the
  // middle.
  const Vector3d turned_N = 0.5 * rest.duration_s * geo::earth_rate_N(position.latitude_rad);
  start.nav.q_NB = geo::normalized(geo::exp(-turned_N) * q_start * rest.q_start_now);
  start.nav.position = position;
  std::array<double, kMaxStates> sigma = setup_->initial_sigma;
  const double oblique = index.has(Group::accel_misalignment) ? 0.0 : imu.accel_misalignment_sigma_rad;
  const double tilt_noise = std::hypot(config.tilt_sigma_floor_rad, rest.tilt_sigma_rad, oblique);
  for (std::size_t i = 0; i < 3; ++i) sigma[3 + i] = config.rest_velocity_sigma_m_s;
  sigma[6] = sigma[7] = tilt_noise;
  sigma[8] = heading_sigma;

  const Matrix3d c = geo::to_matrix(start.nav.q_NB);
  if (!from_gyro) {
    // (ALN-4): the mean rate less the Earth's is the bias, as far as the vehicle was quiet.
    const Vector3d measured =
        rest.mean_rate_B_rad_s - c.transpose() * geo::earth_rate_N(position.latitude_rad);
    const int bias = index.of(Group::gyro_bias);
    for (int i = 0; i < 3; ++i) {
      const double prior = imu.gyro_bias_sigma_rad_s * imu.gyro_bias_sigma_rad_s;
      const double noise = rate_noise * rate_noise + std::pow(horizontal_earth_rate * heading_sigma, 2) +
                           std::pow(geo::kEarthRate_rad_s * tilt_noise, 2);
      const double gain = prior / (prior + noise);
      start.x[static_cast<std::size_t>(bias + i)] = gain * measured(i);
      sigma[static_cast<std::size_t>(bias + i)] = std::sqrt((1.0 - gain) * prior);
    }
  }
  begin(start, sigma);

  // (ALN-5): what the remaining errors of the accelerometers did to the level, and the gyro bias to the
  // gyrocompass.
  const double g = geo::gravity(position.latitude_rad, position.altitude_m);
  Matrix3d t = Matrix3d::Zero();
  t(0, 1) = 1.0 / g;
  t(1, 0) = -1.0 / g;
  const Matrix3d tc = t * c;
  const auto carries = [&](Group group, int component, const Vector3d& force_B) {
    const int state = index.of(group);
    if (state < 0) return;
    const double variance = filter_(state + component, state + component);
    const Vector3d tilt = tc * force_B;
    for (int i = 0; i < 3; ++i) {
      filter_.set(6 + i, state + component, variance * tilt(i));
      for (int k = 0; k <= i; ++k)
        filter_.set(6 + i, 6 + k, filter_(6 + i, 6 + k) + variance * tilt(i) * tilt(k));
    }
  };
  const Vector3d rest_force_B = -g * c.row(2).transpose();
  for (int i = 0; i < 3; ++i) {
    carries(Group::accel_bias, i, Vector3d::Unit(i));
    carries(Group::accel_scale, i, rest_force_B(i) * Vector3d::Unit(i));
    // (IMU-1): two cross terms a row, in the order of the columns.
    carries(Group::accel_misalignment, 2 * i, rest_force_B(i == 0 ? 1 : 0) * Vector3d::Unit(i));
    carries(Group::accel_misalignment, 2 * i + 1, rest_force_B(i == 2 ? 1 : 2) * Vector3d::Unit(i));
  }
  if (from_gyro) {
    const int gyro = index.of(Group::gyro_bias);
    const double variance = imu.gyro_bias_sigma_rad_s * imu.gyro_bias_sigma_rad_s;
    for (int k = 0; k < 3; ++k) filter_.set(8, gyro + k, variance * c(1, k) / horizontal_earth_rate);
  }
}

void Core::start_in_motion() {
  // (ALN-6): the course is the heading, and the mean specific force points up. Neither is exact; the sigmas
  // say so, and the filter finds the rest from the GPS velocity.
  const AlignmentConfig& config = setup_->config.alignment;
  const Eigen::Vector2d tilt = level(smooth_force_);
  FilterState start;
  const double course = std::atan2(gps_velocity_N_.y(), gps_velocity_N_.x());
  start.nav.q_NB = geo::from_rpy(Vector3d(tilt.x(), tilt.y(), course));
  start.nav.position = geo::moved_by(gps_position_, since(gps_seen_ns_) * gps_velocity_N_);
  start.nav.v_N_m_s = gps_velocity_N_;
  std::array<double, kMaxStates> sigma = setup_->initial_sigma;
  for (std::size_t i = 0; i < 3; ++i) sigma[3 + i] = 1.0;
  sigma[6] = sigma[7] = config.in_motion_tilt_sigma_rad;
  sigma[8] = config.in_motion_heading_sigma_rad;
  begin(start, sigma);
}

void Core::begin(const FilterState& state, const std::array<double, kMaxStates>& given_sigma) {
  std::array<double, kMaxStates> sigma = given_sigma;
  state_ = state;
  water_.stop();
  // The position is that of the antenna or of the point set; the IMU lies a lever away from it.
  const bool from_gps = since(gps_seen_ns_) <= kFreshFix_s;
  Vector3d lever = Vector3d::Zero();
  Vector3d position_sigma = Vector3d::Constant(setup_->config.alignment.position_sigma_m);
  if (from_gps) {
    for (const SensorConfig& one : setup_->config.sensors) {
      if (one.kind != SourceKind::gps) continue;
      lever = geo::vec(one.lever_B_m);
      break;
    }
    position_sigma = gps_sigma_N_m_;
  } else if (usbl_places()) {
    const double horizontal = std::max(under_way_.usbl_sigma_m, setup_->config.alignment.position_sigma_m);
    lever = under_way_.usbl_lever_B_m;
    position_sigma = {horizontal, horizontal, setup_->config.states.surface_altitude_sigma_m};
  } else {
    lever = geo::vec(setup_->config.output_lever_B_m);
    if (position_set_) position_sigma.setConstant(set_sigma_m_);
  }
  state_.nav.position = geo::moved_by(state_.nav.position, -(geo::to_matrix(state_.nav.q_NB) * lever));
  for (int i = 0; i < 3; ++i) sigma[static_cast<std::size_t>(i)] = position_sigma(i);
  const int surface = setup_->index.of(Group::surface_altitude);
  if (surface >= 0) {
    // On the surface, unless an acoustic fix has just said how deep below it.
    state_.x[static_cast<std::size_t>(surface)] =
        usbl_places() ? setup_->config.states.surface_altitude_m : state_.nav.position.altitude_m;
  }
  filter_.reset(sigma);
  const int bias = setup_->index.of(Group::gps_position_bias);
  if (from_gps && bias >= 0) {
    // (ALN-7): a position taken from GPS carries the whole of its slow error.
    for (int i = 0; i < 3; ++i) {
      const double variance = filter_(bias + i, bias + i);
      filter_.widen(i, variance);
      filter_.set(i, bias + i, variance);
    }
  }
  navigating_ = levelled_ = true;
  began_ns_ = now_ns_;
  position_set_ = false;
  hold_since_ns_ = 0;
  enter(AlignmentPhase::fine);
}

void Core::start(const InitialState& initial, TimeNs now_ns) {
  now_ns_ = now_ns;
  FilterState start;
  start.nav.position = {initial.latitude_rad, initial.longitude_rad, initial.altitude_m};
  start.nav.v_N_m_s = geo::vec(initial.velocity_N_m_s);
  start.nav.q_NB = geo::from_rpy(geo::vec(initial.rpy_rad));
  // A state without an instant is that of the first inertial sample; one that has aged is carried on as it
  // moved, as far as that means anything.
  const double age_s =
      initial.stamp_ns == 0 ? 0.0 : std::clamp(to_seconds(now_ns - initial.stamp_ns), 0.0, kFreshFix_s);
  start.nav.position = geo::moved_by(start.nav.position, age_s * start.nav.v_N_m_s);
  if (initial.at_output_point) {
    const Matrix3d c = geo::to_matrix(start.nav.q_NB);
    const Vector3d lever = geo::vec(setup_->config.output_lever_B_m);
    start.nav.position = geo::moved_by(start.nav.position, -(c * lever));
    start.nav.v_N_m_s -= c * geo::cross(rate_B_, lever);
  }
  std::array<double, kMaxStates> sigma = setup_->initial_sigma;
  for (std::size_t i = 0; i < 3; ++i) {
    sigma[i] = initial.position_sigma_N_m[i];
    sigma[3 + i] = initial.velocity_sigma_N_m_s[i];
    sigma[6 + i] = initial.attitude_sigma_rad[i];
  }
  // A given start may be in the air or deep down: the surface is where the configuration says, or about
  // there.
  const int surface = setup_->index.of(Group::surface_altitude);
  if (surface >= 0) start.x[static_cast<std::size_t>(surface)] = setup_->config.states.surface_altitude_m;
  state_ = start;
  filter_.reset(sigma);
  navigating_ = levelled_ = true;
  began_ns_ = now_ns_;
  hold_since_ns_ = 0;
  if (setup_->config.alignment.mode == StartMode::air_drop) {
    start_drop(initial);
  } else {
    enter(AlignmentPhase::fine);
  }
}

void Core::watch_alignment() {
  const AlignmentConfig& config = setup_->config.alignment;
  const Vector3d sigma = rpy_sigma_rad();
  const double worst =
      std::max({sigma.x() / config.aligned_tilt_sigma_rad, sigma.y() / config.aligned_tilt_sigma_rad,
                sigma.z() / config.aligned_heading_sigma_rad});
  // Twice as wide to fall out of as to come in, so that the phase does not flap.
  if (worst > (phase_ == AlignmentPhase::aligned ? 2.0 : 1.0)) {
    hold_since_ns_ = 0;
    enter(AlignmentPhase::fine);
    return;
  }
  if (hold_since_ns_ == 0) hold_since_ns_ = now_ns_;
  if (to_seconds(now_ns_ - hold_since_ns_) >= config.aligned_hold_s) enter(AlignmentPhase::aligned);
}

}  // namespace fathom::estimation

#include "estimation/navigator/core.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::estimation {

using Eigen::Vector3d;

namespace {

void fill(std::array<double, kMaxStates>& values, const StateIndex& index, Group group, double value) {
  const int start = index.of(group);
  for (int i = 0; start >= 0 && i < group_size(group); ++i)
    values[static_cast<std::size_t>(start + i)] = value;
}

/// A first-order Gauss-Markov process of the given steady state.
void markov(Setup& setup, Group group, double sigma, double time_constant_s) {
  fill(setup.walk, setup.index, group, 2.0 * sigma * sigma / time_constant_s);
  fill(setup.decay_per_s, setup.index, group, 1.0 / time_constant_s);
}

}  // namespace

Setup::Setup(const EngineConfig& engine_config)
    : config(engine_config),
      index(engine_config.groups),
      q_B_imu(geo::from_rpy(geo::vec(engine_config.imu.mounting_rpy_rad))) {
  int layers = 0;
  water_layer.fill(-1);
  for (std::size_t i = 0; i < config.sensors.size() && i < limits.size(); ++i) {
    limits[i] = gate_limits(config.sensors[i]);
    if (config.sensors[i].kind == SourceKind::dvl && layers < kMaxWaterLayers) water_layer[i] = layers++;
  }
  // A constraint is weighed down as far as it is broken and never refused: a slide ends some time.
  constraint_gate.robust = RobustKind::student_t;
  constraint_gate.robust_reject_ratio = 1e12;
  constraint_limits = gate_limits(constraint_gate);

  const ImuConfig& imu = config.imu;
  const StateModelConfig& model = config.states;
  const auto sigma = [&](Group group, double value) { fill(initial_sigma, index, group, value); };
  sigma(Group::accel_bias, imu.accel_bias_sigma_m_s2);
  sigma(Group::gyro_bias, imu.gyro_bias_sigma_rad_s);
  // The turn-on part does not decay, so the in-run part is a random walk of the same growth.
  const double accel = imu.accel_bias_instability_m_s2;
  const double gyro = imu.gyro_bias_instability_rad_s;
  fill(walk, index, Group::accel_bias, 2.0 * accel * accel / imu.accel_bias_time_constant_s);
  fill(walk, index, Group::gyro_bias, 2.0 * gyro * gyro / imu.gyro_bias_time_constant_s);
  sigma(Group::accel_scale, imu.accel_scale_sigma);
  sigma(Group::gyro_scale, imu.gyro_scale_sigma);
  sigma(Group::accel_misalignment, imu.accel_misalignment_sigma_rad);
  sigma(Group::gyro_misalignment, imu.gyro_misalignment_sigma_rad);
  sigma(Group::dvl_scale, model.dvl_scale_sigma);
  sigma(Group::dvl_scale_xyz, model.dvl_scale_sigma);
  sigma(Group::dvl_misalignment, model.dvl_misalignment_sigma_rad);
  sigma(Group::dvl_bias, model.dvl_bias_sigma_m_s);
  sigma(Group::current, model.current_sigma_m_s);
  if (model.current_time_constant_s > 0.0)
    markov(*this, Group::current, model.current_sigma_m_s, model.current_time_constant_s);
  sigma(Group::depth_bias, model.depth_bias_sigma_m);
  sigma(Group::surface_altitude, model.surface_altitude_sigma_m);
  fill(walk, index, Group::surface_altitude,
       model.surface_altitude_walk_m_sqrt_s * model.surface_altitude_walk_m_sqrt_s);
  sigma(Group::heading_bias, model.heading_bias_sigma_rad);
  if (model.heading_bias_time_constant_s > 0.0)
    markov(*this, Group::heading_bias, model.heading_bias_sigma_rad, model.heading_bias_time_constant_s);
  sigma(Group::heading_deviation, model.heading_deviation_sigma_rad);
  sigma(Group::usbl_bias, model.usbl_bias_sigma_m);
  sigma(Group::gps_position_bias, model.gps_bias_sigma_m);
  markov(*this, Group::gps_position_bias, model.gps_bias_sigma_m, model.gps_bias_time_constant_s);
  if (const int bias = index.of(Group::gps_position_bias); bias >= 0) {
    initial_sigma[static_cast<std::size_t>(bias + 2)] *= 2.0;
    walk[static_cast<std::size_t>(bias + 2)] *= 4.0;
  }
  sigma(Group::usbl_misalignment, model.usbl_misalignment_sigma_rad);
  sigma(Group::gps_latency, model.gps_latency_sigma_s);
  sigma(Group::gps_lever, model.gps_lever_sigma_m);
  sigma(Group::log_scale, model.log_scale_sigma);
  sigma(Group::airspeed_bias, model.airspeed_bias_sigma_m_s);
  sigma(Group::airspeed_scale, model.airspeed_scale_sigma);
  sigma(Group::flow_angles, model.flow_angle_sigma_rad);
  markov(*this, Group::flow_angles, model.flow_angle_sigma_rad, model.flow_angle_time_constant_s);
  sigma(Group::baro_bias, model.baro_bias_sigma_m);
  fill(walk, index, Group::baro_bias, model.baro_bias_walk_m_sqrt_s * model.baro_bias_walk_m_sqrt_s);
  sigma(Group::mount_angles, model.mount_angle_sigma_rad);
  sigma(Group::mount_lever, model.mount_lever_sigma_m);
  sigma(Group::model_scale, model.model_scale_sigma);
  sigma(Group::model_bias, model.model_bias_sigma_m_s);
  markov(*this, Group::model_bias, model.model_bias_sigma_m_s, model.model_bias_time_constant_s);
  model_gate.reacquire_s = 0.0;
  model_limits = gate_limits(model_gate);
  if (config.vehicle_model.enabled) velocity_model.emplace(config.vehicle_model.coefficients);
  drift = StateDrift(walk, decay_per_s, index.size());
}

Core::Core(const Setup& setup) : setup_(&setup), filter_(setup.index.size()) {
  for (std::size_t i = 0; i < setup.config.sensors.size(); ++i)
    sensors_[i].enabled = setup.config.sensors[i].enabled;
}

bool Core::remembers_the_past_only() const {
  bool past = true;
  const auto hold = [&](TimeNs stamp_ns) { past = past && (stamp_ns == 0 || stamp_ns <= now_ns_); };
  for (const TimeNs stamp :
       {gps_used_ns_, usbl_used_ns_, dvl_used_ns_, bottom_used_ns_, velocity_used_ns_, stepped_ns_,
        phase_since_ns_, waiting_since_ns_, began_ns_, hold_since_ns_, gps_seen_ns_, held_ns_,
        under_way_.heading_ns, under_way_.dvl_ns, under_way_.usbl_ns})
    hold(stamp);
  const auto hold_all = [&](const Sensor& sensor) {
    hold(sensor.stamp_ns);
    hold(sensor.used_ns);
    for (const Sensor::Rejections& one : sensor.rejections) hold(one.since_ns);
    hold(sensor.candidate.refused_since_ns);
    hold(sensor.candidate.since_ns);
    hold(sensor.candidate.last_ns);
  };
  std::for_each(sensors_.begin(), sensors_.end(), hold_all);
  std::for_each(water_layers_.begin(), water_layers_.end(), hold_all);
  return past;
}

ProcessNoise Core::process_noise(const Eigen::Matrix3d& C_NB, const Vector3d& rate_B_rad_s,
                                 const Vector3d& force_B_m_s2) const {
  // (NOISE-1): white noise, and as equivalent noise the scale and misalignment that are not estimated.
  const ImuConfig& imu = setup_->config.imu;
  const StateGroups& groups = setup_->config.groups;
  const double arw = imu.angle_random_walk_rad_sqrt_s;
  const double vrw = imu.velocity_random_walk_m_s_sqrt_s;
  ProcessNoise noise;
  noise.drift = &setup_->drift;
  noise.attitude = arw * arw * Eigen::Matrix3d::Identity();
  noise.velocity = vrw * vrw * Eigen::Matrix3d::Identity();
  const auto add = [&](Eigen::Matrix3d& to, const Vector3d& input, bool scale, double scale_sigma,
                       bool misalignment, double misalignment_sigma) {
    if (scale && misalignment) return;
    const Vector3d squares = input.cwiseAbs2();
    Vector3d variance = Vector3d::Zero();
    if (!scale) variance += scale_sigma * scale_sigma * squares;
    if (!misalignment)
      variance += misalignment_sigma * misalignment_sigma * (Vector3d::Constant(squares.sum()) - squares);
    to += C_NB * (imu.equivalent_noise_time_s * variance).asDiagonal() * C_NB.transpose();
  };
  add(noise.attitude, rate_B_rad_s, groups.gyro_scale, imu.gyro_scale_sigma, groups.gyro_misalignment,
      imu.gyro_misalignment_sigma_rad);
  // Gravity is always there and looks like a bias; only the changing part of the force counts.
  add(noise.velocity, force_B_m_s2 + 9.81 * C_NB.row(2).transpose(), groups.accel_scale,
      imu.accel_scale_sigma, groups.accel_misalignment, imu.accel_misalignment_sigma_rad);
  return noise;
}

void Core::settle_biases(ErrorFilter& filter, double ahead_s, double dt_s) const {
  // (NOISE-2)
  const ImuConfig& imu = setup_->config.imu;
  if (imu.gyro_bias_settling_rad_s <= 0.0 && imu.accel_bias_settling_m_s2 <= 0.0) return;
  const double age_s = std::max(to_seconds(now_ns_ - began_ns_) + ahead_s, 0.0);
  const double rate = 2.0 / imu.bias_settling_time_s;
  const double share = std::exp(-rate * age_s) - std::exp(-rate * (age_s + dt_s));
  const auto widen = [&](Group group, double sigma) {
    const int first = setup_->index.of(group);
    for (int i = 0; i < 3; ++i) filter.widen(first + i, share * sigma * sigma);
  };
  widen(Group::gyro_bias, imu.gyro_bias_settling_rad_s);
  widen(Group::accel_bias, imu.accel_bias_settling_m_s2);
}

void Core::advance(const ImuStep& step, TimeNs until_ns) {
  const double whole_s = step.increments.dt_s;
  const double fraction =
      static_cast<double>(until_ns - now_ns_) / static_cast<double>(step.to_ns - step.from_ns);
  now_ns_ = until_ns;
  if (!(fraction > 0.0)) return;
  const auto& x = state_.x;
  const StateIndex& index = setup_->index;
  const double per_s = 1.0 / whole_s;
  rate_B_ = corrected_rate(index, x, per_s * step.increments.dtheta_rad);
  force_B_ = corrected_force(index, x, per_s * step.increments.dv_m_s);
  if (!navigating_) return;

  Increments in;
  in.dt_s = whole_s;
  in.dtheta_rad = whole_s * rate_B_;
  in.dv_m_s = whole_s * force_B_;
  in.dtheta_before_rad = whole_s * corrected_rate(index, x, per_s * step.increments.dtheta_before_rad);
  in.dv_before_m_s = whole_s * corrected_force(index, x, per_s * step.increments.dv_before_m_s);
  const double dt = fraction * whole_s;

  const geo::LocalEarth earth(state_.nav.position);
  const Eigen::Matrix3d c = geo::to_matrix(state_.nav.q_NB);
  const Vector3d v_before = state_.nav.v_N_m_s;
  const ErrorRates rates = error_rates(earth, v_before, c * force_B_);
  filter_.propagate(NavTransition(index, rates, c, rate_B_, force_B_, dt),
                    process_noise(c, rate_B_, force_B_));
  settle_biases(filter_, -dt, dt);
  state_.nav = mechanise(state_.nav, earth, c, correct(in, fraction));
  travelled_N_m_ += 0.5 * dt * (v_before + state_.nav.v_N_m_s);
  for (const std::uint8_t state : setup_->drift.decaying()) state_.x[state] *= setup_->drift.kept(state, dt);
}

void Core::finish(const ImuStep& step) {
  const ImuConfig& imu = setup_->config.imu;
  if (step.gap_s > 0.0) {
    if (step.gap_s > imu.lost_gap_s) {
      if (!resume_drop(step.gap_s)) lose_attitude();
    } else if (navigating_) {
      const GapSigma sigma(imu, step.gap_s);
      for (int i = 0; i < 3; ++i) {
        filter_.widen(i, sigma.position_m * sigma.position_m);
        filter_.widen(3 + i, sigma.velocity_m_s * sigma.velocity_m_s);
        filter_.widen(6 + i, sigma.angle_rad * sigma.angle_rad);
      }
      if (dropping_) widen_drop(sigma);
    }
    window_.reset();
  }
  if (!navigating_) {
    align(step);
    return;
  }
  if (dropping_) {
    advance_drop(step);
    return;
  }
  if (setup_->velocity_model) foretell_velocity(step);
  apply_constraints(step);
  watch_alignment();
}

void Core::replace(const FilterState& state, const ErrorFilter& filter) {
  const auto bias = [&](const FilterState& of, Group group) {
    const auto at = static_cast<std::size_t>(setup_->index.of(group));
    return Vector3d(of.x[at], of.x[at + 1], of.x[at + 2]);
  };
  rate_B_ += bias(state_, Group::gyro_bias) - bias(state, Group::gyro_bias);
  force_B_ += bias(state_, Group::accel_bias) - bias(state, Group::accel_bias);
  state_ = state;
  filter_ = filter;
}

void Core::rebase(TimeNs now_ns, double unobserved_s) {
  const DurationNs shift = now_ns - now_ns_ - from_seconds(unobserved_s);
  const auto move = [shift](TimeNs& stamp) {
    if (stamp != 0) stamp += shift;
  };
  for (TimeNs* stamp : {&gps_used_ns_, &usbl_used_ns_, &dvl_used_ns_, &bottom_used_ns_, &velocity_used_ns_,
                        &stepped_ns_, &rest_until_ns_, &next_zero_velocity_ns_, &phase_since_ns_,
                        &waiting_since_ns_, &began_ns_, &hold_since_ns_, &gps_seen_ns_, &held_ns_,
                        &under_way_.heading_ns, &under_way_.dvl_ns, &under_way_.usbl_ns})
    move(*stamp);
  const auto move_all = [&](Sensor& sensor) {
    move(sensor.used_ns);
    for (Sensor::Rejections& one : sensor.rejections) move(one.since_ns);
    move(sensor.candidate.refused_since_ns);
    move(sensor.candidate.since_ns);
    move(sensor.candidate.last_ns);
    sensor.stamp_ns = 0;
  };
  std::for_each(sensors_.begin(), sensors_.end(), move_all);
  std::for_each(water_layers_.begin(), water_layers_.end(), move_all);
  now_ns_ = now_ns;
  ImuStep silence;
  silence.gap_s = unobserved_s;
  if (!(unobserved_s > 0.0) || !navigating_) return;
  state_.nav.position = geo::moved_by(state_.nav.position, unobserved_s * state_.nav.v_N_m_s);
  finish(silence);
}

void Core::lose_attitude() {
  navigating_ = false;
  levelled_ = false;
  dropping_ = false;
  window_.reset();
  smooth_time_s_ = 0.0;
  fast_fixes_ = 0;
  enter(AlignmentPhase::lost);
  waiting_since_ns_ = now_ns_;
}

AidingState Core::aiding_state() const {
  const EngineConfig& config = setup_->config;
  return {setup_->index, state_, rate_B_,
          config.magnetic_variation_known ? config.magnetic_variation_rad : kUnknown, force_B_};
}

NavMode Core::mode() const {
  const EngineConfig& config = setup_->config;
  if (!navigating_) return levelled_ ? NavMode::aligning : NavMode::none;
  // Comparisons with NaN are false: never used.
  if (since(gps_used_ns_) <= config.gps_timeout_s) return NavMode::gps_aided;
  if (since(usbl_used_ns_) <= config.usbl_timeout_s) return NavMode::acoustic_aided;
  if (since(velocity_used_ns_) <= config.velocity_timeout_s) return NavMode::dead_reckoning;
  return NavMode::inertial;
}

}  // namespace fathom::estimation

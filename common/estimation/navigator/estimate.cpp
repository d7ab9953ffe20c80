#include "estimation/navigator/estimate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::estimation {

using Eigen::Vector3d;

namespace {

/// A heading known better than this turns nothing far.
constexpr double kKnownHeading_rad = 0.01;
/// A level known better than this leaves gravity as long as it is.
constexpr double kKnownLevel_rad = 0.035;
/// How long the error of an acceleration keeps its value, where GPS renews it (NOISE-3).
constexpr double kProductMemory_s = 3.0;
/// How long tilt and accelerometer bias keep what they share (NOISE-3), and how long a gyro bias takes to
/// follow a change (NOISE-4).
constexpr double kDriftMemory_s = 30.0;

/// What place and velocity are off by besides what is linear in a heading error, per 1 - cos of it: an arc
/// ends short of its tangent. `linear` is per radian about down.
std::array<double, kMaxStates> short_of_tangent(const std::array<double, kMaxStates>& linear) {
  std::array<double, kMaxStates> out{};
  for (const std::size_t north : {0U, 3U}) {
    out[north] = -linear[north + 1];
    out[north + 1] = linear[north];
  }
  return out;
}

/// Gives `target`, a covariance or what is said of the biases, this share of what they settle by (NOISE-2).
template <class Target>
void settle(const Setup& setup, double share, Target& target) {
  const auto widen_group = [&](Group group, double sigma) {
    const int first = setup.index.of(group);
    for (int i = 0; i < 3; ++i) target.widen(first + i, share * sigma * sigma);
  };
  widen_group(Group::gyro_bias, setup.config.imu.gyro_bias_settling_rad_s);
  widen_group(Group::accel_bias, setup.config.imu.accel_bias_settling_m_s2);
}

Vector3d bias(const Setup& setup, const FilterState& state, Group group) {
  const auto at = static_cast<std::size_t>(setup.index.of(group));
  return {state.x[at], state.x[at + 1], state.x[at + 2]};
}

/// (ALN-19) Nothing is measured for this long: the vehicle keeps roll, pitch and speed and turns on about
/// down. What swings goes to and fro; a turn lasts.
void coast(const Setup& setup, double dt_s, Estimate& estimate) {
  constexpr double kLongest_s = 0.1;
  const double parts = std::max(1.0, std::ceil(dt_s / kLongest_s));
  CorrectedIncrements in;
  in.dt_s = dt_s / parts;
  NavSolution& nav = estimate.state.nav;
  Vector3d turn_N = Vector3d::Zero();
  for (double part = 0.0; part < parts; part += 1.0) {
    const geo::LocalEarth earth(nav.position);
    const Eigen::Matrix3d c = geo::to_matrix(nav.q_NB);
    const Vector3d v_before = nav.v_N_m_s;
    const Vector3d rate_in_N = earth.earth_rate_N + earth.transport_rate_N(v_before);
    if (part == 0.0) turn_N.z() = estimate.turn_rad_s() - rate_in_N.z();
    estimate.rate_B_rad_s = c.transpose() * (rate_in_N + turn_N);
    estimate.force_B_m_s2 =
        c.transpose() * (geo::cross(turn_N + earth.earth_rate_N + rate_in_N, v_before) - earth.gravity_N());
    in.rotation_rad = in.dt_s * estimate.rate_B_rad_s;
    in.dv_m_s = in.dt_s * (estimate.force_B_m_s2 + 0.5 * geo::cross(in.rotation_rad, estimate.force_B_m_s2));
    estimate.stride.add(in.dt_s, c, estimate.rate_B_rad_s, estimate.force_B_m_s2);
    nav = mechanise(nav, earth, c, in);
    estimate.travelled_N_m += 0.5 * in.dt_s * (v_before + nav.v_N_m_s);
    if (estimate.stride.is_due(setup.stride_s)) estimate.follow(setup);
  }
}

}  // namespace

void Estimate::advance(const Setup& setup, const ImuStep& step, TimeNs until_ns) {
  const double whole_s = step.increments.dt_s;
  const double fraction =
      static_cast<double>(until_ns - now_ns) / static_cast<double>(step.to_ns - step.from_ns);
  now_ns = until_ns;
  if (!(fraction > 0.0)) return;
  const auto& x = state.x;
  const StateIndex& index = setup.index;
  const double per_s = 1.0 / whole_s;
  rate_B_rad_s = corrected_rate(index, x, per_s * step.increments.dtheta_rad);
  force_B_m_s2 = corrected_force(index, x, per_s * step.increments.dv_m_s);
  if (!navigating) return;
  // One that falls keeps no speed.
  if (step.gap_s > 0.0 && setup.config.alignment.mode != StartMode::air_drop)
    return coast(setup, fraction * whole_s, *this);

  Increments in;
  in.dt_s = whole_s;
  in.dtheta_rad = whole_s * rate_B_rad_s;
  in.dv_m_s = whole_s * force_B_m_s2;
  in.dtheta_before_rad = whole_s * corrected_rate(index, x, per_s * step.increments.dtheta_before_rad);
  in.dv_before_m_s = whole_s * corrected_force(index, x, per_s * step.increments.dv_before_m_s);
  const double dt = fraction * whole_s;

  const geo::LocalEarth earth(state.nav.position);
  const Eigen::Matrix3d c = geo::to_matrix(state.nav.q_NB);
  const Vector3d v_before = state.nav.v_N_m_s;
  stride.add(dt, c, rate_B_rad_s, force_B_m_s2);
  state.nav = mechanise(state.nav, earth, c, correct(in, fraction));
  travelled_N_m += 0.5 * dt * (v_before + state.nav.v_N_m_s);
  if (stride.is_due(setup.stride_s)) follow(setup);
}

void Estimate::follow(const Setup& setup) {
  // (KF-1)
  if (stride.is_empty()) return;
  const double dt = stride.dt_s();
  const Eigen::Matrix3d c = stride.C_NB();
  const Vector3d force_N_m_s2 = stride.force_N_m_s2();
  const ErrorRates rates = error_rates(geo::LocalEarth(state.nav.position), state.nav.v_N_m_s, force_N_m_s2);
  ProcessNoise noise = setup.process_noise(c, stride.squares());
  add_second_order(setup, c, force_N_m_s2, noise);
  add_g_sensitivity(setup, noise);
  motion_noise.widen(setup.imu_noise, noise);
  const NavTransition step(setup.index, rates, c, stride.rate_B_rad_s(), stride.force_B_m_s2(), dt);
  filter.propagate(step, noise);
  start_heading.propagated(step, noise);
  bias_prior.propagated(setup.drift, dt, state, filter);
  motion_noise.propagated(step, noise, setup.imu_noise,
                          setup.doubts_imu() ? setup.config.imu.max_noise_factor : 1.0);
  if (const double share = settling_share(setup, -dt, dt); share > 0.0) {
    settle(setup, share, filter);
    settle(setup, share, bias_prior);
  }
  slow_gps.drive(setup.drift, dt, filter);
  for (const std::uint8_t one : setup.drift.decaying()) state.x[one] *= setup.drift.kept(one, dt);
  stride = {};
}

void Estimate::add_second_order(const Setup& setup, const Eigen::Matrix3d& C_NB, const Vector3d& force_N_m_s2,
                                ProcessNoise& noise) const {
  // (NOISE-3)
  const double heading = filter(8, 8);
  const bool turns = heading >= kKnownHeading_rad * kKnownHeading_rad;
  const bool leans = filter(6, 6) + filter(7, 7) >= kKnownLevel_rad * kKnownLevel_rad;
  if (!turns && !leans) return;
  const int accel = setup.index.of(Group::accel_bias);
  const int gyro = setup.index.of(Group::gyro_bias);
  const Eigen::Matrix3d force = geo::skew(force_N_m_s2);
  const Eigen::Matrix3d tilts = filter.block3(6, 6);
  const Eigen::Matrix3d bias = filter.block3(6, accel) * C_NB.transpose();
  const Eigen::Matrix3d cross = force * bias;
  const Eigen::Matrix3d acceleration = force * tilts * force.transpose() + cross + cross.transpose() +
                                       C_NB * filter.block3(accel, accel) * C_NB.transpose();
  Eigen::Matrix3d about_down = Eigen::Matrix3d::Zero();
  about_down(0, 1) = -1.0;
  about_down(1, 0) = 1.0;
  if (turns) {
    noise.velocity += kProductMemory_s * heading * about_down * acceleration * about_down.transpose();
    const Vector3d down_B = C_NB.row(2).transpose();
    const double rate = down_B.dot(filter.block3(gyro, gyro) * down_B);
    noise.attitude += kDriftMemory_s * rate * about_down * tilts * about_down.transpose();
  }
  if (leans) {
    const Eigen::Matrix2d level = tilts.topLeftCorner<2, 2>();
    const Eigen::Matrix2d both =
        ((tilts * force.transpose() + bias) * about_down).topLeftCorner<2, 2>();  // of the level and ...
    const Eigen::Matrix2d turned = (about_down.transpose() * acceleration * about_down)
                                       .topLeftCorner<2, 2>();  // ... of what it brings about
    const double square = both.trace() * both.trace() + (level * turned).trace() + (both * both).trace();
    noise.velocity(2, 2) += 0.25 * kProductMemory_s * square;
  }
}

void Estimate::add_g_sensitivity(const Setup& setup, ProcessNoise& noise) {
  // (NOISE-4)
  const double k = setup.config.imu.gyro_g_sensitivity_rad_s_per_m_s2;
  if (k <= 0.0) return;
  const Vector3d fresh = stride.force_B_m_s2() - usual_force_B_m_s2;
  const Vector3d learned = usual_force_B_m_s2 + Vector3d(0.0, 0.0, kStandardGravity_m_s2);
  noise.attitude.diagonal().array() += 2.0 * kDriftMemory_s * k * k * std::max(0.0, learned.dot(fresh));
  usual_force_B_m_s2 += (1.0 - std::exp(-stride.dt_s() / kDriftMemory_s)) * fresh;
}

double Estimate::settling_share(const Setup& setup, double ahead_s, double dt_s) const {
  // (NOISE-2)
  const ImuConfig& imu = setup.config.imu;
  if (imu.gyro_bias_settling_rad_s <= 0.0 && imu.accel_bias_settling_m_s2 <= 0.0) return 0.0;
  const double age_s = std::max(to_seconds(now_ns - began_ns) + ahead_s, 0.0);
  const double rate = 2.0 / imu.bias_settling_time_s;
  return std::exp(-rate * age_s) - std::exp(-rate * (age_s + dt_s));
}

void Estimate::drive_biases(const Setup& setup, ErrorFilter& covariance, double ahead_s, double dt_s) const {
  slow_gps.drive(setup.drift, dt_s, covariance);
  if (const double share = settling_share(setup, ahead_s, dt_s); share > 0.0)
    settle(setup, share, covariance);
}

bool Estimate::is_sound() const {
  constexpr double kPole_rad = 1.5707963267948966;
  constexpr int kKinematic = 9;
  const NavSolution& nav = state.nav;
  const auto& q = nav.q_NB;
  double sum =
      q.w + q.x + q.y + q.z + nav.v_N_m_s.sum() + nav.position.longitude_rad + nav.position.altitude_m;
  for (int i = 0; i < kKinematic; ++i) sum += filter(i, i);
  return std::isfinite(sum) && std::abs(nav.position.latitude_rad) <= kPole_rad;
}

void Estimate::widen(const GapSigma& sigma) {
  motion_noise.interrupt();
  for (int i = 0; i < 3; ++i) {
    filter.widen(i, sigma.position_m * sigma.position_m);
    filter.widen(3 + i, sigma.velocity_m_s * sigma.velocity_m_s);
    filter.widen(6 + i, sigma.angle_rad * sigma.angle_rad);
  }
}

void Estimate::widen_heading(double variance_rad2) {
  motion_noise.interrupt();
  constexpr int kHeading = 8;
  std::array<double, kMaxStates> with{};
  std::array<double, kMaxStates> place{};
  for (int i = 0; i < kNavStates; ++i)
    (i < 3 ? place : with)[static_cast<std::size_t>(i)] = filter(i, kHeading) / filter(kHeading, kHeading);
  filter.shift(with, 0.0, variance_rad2);
  filter.shift(place, 0.0, variance_rad2);
  const double short_of = 1.0 - std::cos(std::min(std::sqrt(variance_rad2), std::numbers::pi));
  filter.shift(short_of_tangent(with), 0.0, short_of * short_of);
  filter.shift(short_of_tangent(place), 0.0, short_of * short_of);
}

bool Estimate::update(const Setup& setup, const Observation& observation,
                      const InnovationStatistics& statistics, VelocityOver along, ShowsStart shows,
                      std::array<double, kMaxStates>& x) {
  const Vector3d before = velocity_N_m_s(setup, along);
  if (!filter.update(observation, statistics, x)) return false;
  if (start_heading.is_open()) start_heading.updated(observation, statistics, filter, turn_rad_s(), shows);
  motion_noise.updated(observation, statistics, filter);
  move(setup, x, before, along);
  return true;
}

void Estimate::move(const Setup& setup, const std::array<double, kMaxStates>& x, const Vector3d& before_N_m_s,
                    VelocityOver along) {
  remove_error(x, filter.estimated(), state);
  const Carry carry =
      carried(filter, x, geo::to_matrix(state.nav.q_NB), before_N_m_s, velocity_N_m_s(setup, along));
  filter.carry(carry);
  start_heading.carried(carry);
  motion_noise.carried(carry);
}

void Estimate::correct_start(const Setup& setup, VelocityOver along, std::array<double, kMaxStates>& x) {
  // (GATE-9)
  const Vector3d before = velocity_N_m_s(setup, along);
  const StartHeading::Column linear = start_heading.column();
  const StartHeading::Column arc = short_of_tangent(linear);
  const double error_rad = start_heading.error_rad();
  const double short_of = 1.0 - std::cos(error_rad);
  filter.shift(linear, error_rad, start_heading.variance_rad2() + short_of * short_of);
  filter.shift(arc, short_of, short_of * short_of);
  std::array<double, kMaxStates> moved{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(filter.estimated()); ++i)
    moved[i] = error_rad * linear[i] + short_of * arc[i];
  start_heading.corrected();
  bias_prior.interrupt();
  motion_noise.interrupt();
  move_further(setup, moved, before, along, x);
}

bool Estimate::correct_bias(const Setup& setup, VelocityOver along, std::array<double, kMaxStates>& x) {
  // (GATE-11)
  if (!setup.doubts_imu()) return false;
  const std::optional<BiasPrior::Wrong> wrong = bias_prior.wrong(state, filter);
  if (!wrong) return false;
  motion_noise.interrupt();
  take_back(setup, wrong->state, wrong->share, wrong->beyond, along, x);
  bias_prior.corrected(*wrong);
  return true;
}

bool Estimate::correct_slow_error(const Setup& setup, int error, double variance_m2, VelocityOver along,
                                  std::array<double, kMaxStates>& x) {
  // (GATE-13)
  SlowError& slow = slow_gps.has(error) ? slow_gps : slow_usbl.has(error) ? slow_usbl : slow_antennas;
  const double share = slow.share_of(error, variance_m2, filter);
  if (share <= 0.0) return false;
  take_back(setup, error, share, state.x[static_cast<std::size_t>(error)], along, x);
  slow.grow(error, variance_m2);
  return true;
}

void Estimate::take_back(const Setup& setup, int state_number, double share, double beyond,
                         VelocityOver along, std::array<double, kMaxStates>& x) {
  const Vector3d before = velocity_N_m_s(setup, along);
  const double by = share * beyond;
  std::array<double, kMaxStates> column{};
  for (int i = 0; i < filter.size(); ++i) column[static_cast<std::size_t>(i)] = filter(i, state_number);
  std::array<double, kMaxStates> moved{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(filter.estimated()); ++i) moved[i] = by * column[i];
  filter.shift(column, by, share);
  start_heading.shifted(column, share, static_cast<std::size_t>(state_number));
  move_further(setup, moved, before, along, x);
}

void Estimate::move_further(const Setup& setup, const std::array<double, kMaxStates>& moved,
                            const Vector3d& before_N_m_s, VelocityOver along,
                            std::array<double, kMaxStates>& x) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(filter.estimated()); ++i) x[i] += moved[i];
  move(setup, moved, before_N_m_s, along);
}

double Estimate::turn_rad_s() const {
  return geo::to_matrix(state.nav.q_NB).row(2).dot(rate_B_rad_s);
}

Vector3d Estimate::gyro_bias_rad_s(const Setup& setup) const {
  return bias(setup, state, Group::gyro_bias);
}

Vector3d Estimate::velocity_N_m_s(const Setup& setup, VelocityOver reference) const {
  const Vector3d& v_N_m_s = state.nav.v_N_m_s;
  return reference == VelocityOver::medium ? Vector3d(v_N_m_s - current_N_m_s(setup)) : v_N_m_s;
}

void Estimate::replace(const Setup& setup, const FilterState& other, const ErrorFilter& covariance) {
  const auto moved = [&](Group group) {
    return Vector3d(bias(setup, state, group) - bias(setup, other, group));
  };
  rate_B_rad_s += moved(Group::gyro_bias);
  force_B_m_s2 += moved(Group::accel_bias);
  state = other;
  filter = covariance;
  start_heading.end();
  bias_prior.interrupt();
  motion_noise.interrupt();
  stride = {};
}

void Estimate::forget(int state, double sigma) {
  filter.forget(state, sigma);
  start_heading.forgot(static_cast<std::size_t>(state));
  bias_prior.interrupt();
  motion_noise.interrupt();
}

void Estimate::forget_covariance(const std::array<double, kMaxStates>& sigma) {
  filter.reset(sigma);
  start_heading.end();
  bias_prior.begin(state, filter);
  slow_gps.begin();
  slow_usbl.begin();
  slow_antennas.begin();
  motion_noise.begin();
  stride = {};
}

void Estimate::begin(const FilterState& start, const std::array<double, kMaxStates>& sigma) {
  state = start;
  forget_covariance(sigma);
  navigating = levelled = true;
  began_ns = now_ns;
}

void Estimate::consider_anew(const Setup& setup, int from) {
  for (int i = from; i < filter.size(); ++i)
    filter.forget(i, setup.initial_sigma[static_cast<std::size_t>(i)]);
}

Vector3d Estimate::current_N_m_s(const Setup& setup) const {
  const int at = setup.index.of(Group::current);
  if (at < 0) return Vector3d::Zero();
  return {state.x[static_cast<std::size_t>(at)], state.x[static_cast<std::size_t>(at) + 1], 0.0};
}

}  // namespace fathom::estimation

#include "estimation/navigator/start/starter.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/aiding/gps_position.hpp"
#include "estimation/aiding/gps_velocity.hpp"
#include "estimation/aiding/heading.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastWindow_s = 0.5;
constexpr double kWindowsKept = 4.0;
/// What a vehicle may climb by that nobody measures.
constexpr double kUnknownVertical_m_s = 3.0;

}  // namespace

void Starter::collect(const Setup& setup, const Estimate& estimate, const Measurement& measurement) {
  const SensorConfig& config = setup.sensor(measurement.sensor);
  if (const auto* gps = std::get_if<GpsSample>(&measurement.sample)) {
    collect_gps(setup, estimate, config, *gps);
    return;
  }
  if (estimate.navigating) return;
  collect_under_way(setup, estimate, measurement, config);
  if (const auto* heading = std::get_if<HeadingSample>(&measurement.sample)) {
    const double psi = true_heading(*heading, setup.magnetic_variation_rad()) - config.mounting_rpy_rad[2];
    const AlignmentConfig& alignment = setup.config.alignment;
    if (std::abs(psi) < 20.0 && window_.duration_s() > 0.0 && heading_wanted(alignment, config))
      window_.add_heading(psi, heading_sigma(alignment, config, *heading), config.two_antenna);
  }
}

void Starter::collect_gps(const Setup& setup, const Estimate& estimate, const SensorConfig& config,
                          const GpsSample& gps) {
  if (!is_fixed(config, gps)) return;
  if (!is_on_earth(gps.latitude_rad, gps.longitude_rad)) return;
  Vector3d v = geo::vec(gps.velocity_N_m_s);
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(v(i)) < kMostGpsSpeed_m_s)) v(i) = kUnknown;
  if (!known(v.x()) || !known(v.y())) v.head<2>().setConstant(kUnknown);
  const double speed = std::hypot(v.x(), v.y());
  gps_speed_m_s_ = speed;
  const double fast_m_s = setup.config.alignment.in_motion_speed_m_s;
  const bool fast = fast_m_s > 0.0 && speed > fast_m_s && speed < kMostGpsSpeed_m_s;
  fast_fixes_ = fast ? fast_fixes_ + 1 : 0;
  gps_seen_ns_ = estimate.now_ns;
  gps_lever_B_m_ = geo::vec(config.lever_B_m);
  const bool high = std::abs(gps.altitude_m) < kMostAltitude_m;  // false where it is unknown
  gps_position_ = {gps.latitude_rad, gps.longitude_rad, high ? gps.altitude_m : 0.0};
  gps_velocity_N_ = {v.x(), v.y(), std::isfinite(v.z()) ? v.z() : 0.0};
  if (known(speed) && !estimate.navigating) {
    Vector3d sigma;
    for (std::size_t i = 0; i < 3; ++i)
      sigma(static_cast<int>(i)) =
          sigma_of(config.velocity_sigma_m_s[i], gps.velocity_sigma_N_m_s[i], config.use_sample_sigma);
    if (!std::isfinite(v.z())) sigma.z() = kUnknownVertical_m_s;
    velocities_.measured(estimate.now_ns, gps_velocity_N_, sigma);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double sigma = sigma_of(config.sigma[i], gps.position_sigma_N_m[i], config.use_sample_sigma);
    gps_sigma_N_m_(static_cast<int>(i)) = std::max(sigma, setup.config.alignment.position_sigma_m);
  }
  if (!high) gps_sigma_N_m_.z() = 200.0;
}

void Starter::forget() {
  interrupt();
  smooth_time_s_ = 0.0;
  fast_fixes_ = 0;
}

HeadingSource Starter::heading_source(const Setup& setup) const {
  const HeadingSource source = setup.config.alignment.heading_source;
  return source == HeadingSource::given && out_of_sight_ ? HeadingSource::automatic : source;
}

StartConditions Starter::conditions(const StartInputs& in) const {
  const AlignmentConfig& config = in.setup.config.alignment;
  StartConditions c;
  c.window_full = window_.duration_s() >= config.averaging_s;
  c.quiet = window_.rate_spread_rad_s() <= config.rate_spread_rad_s &&
            window_.force_spread_m_s2() <= config.force_spread_m_s2;
  // Without a fresh speed there is nothing to say against rest.
  c.slow = !(in.estimate.since(gps_seen_ns_) <= kFreshFix_s && gps_speed_m_s_ > config.max_speed_m_s);
  const HeadingSource source = heading_source(in.setup);
  c.heading =
      source == HeadingSource::given || source == HeadingSource::gyrocompass || window_.headings() > 0;
  c.position = place(in).has_value();
  return c;
}

bool Starter::align(const StartInputs& in, bool released, const ImuStep& step, Estimate& estimate,
                    AlignmentWatch& alignment) {
  const AlignmentConfig& config = in.setup.config.alignment;
  const double dt_s = step.increments.dt_s;
  const TimeNs now_ns = estimate.now_ns;
  const Vector3d force = step.increments.dv_m_s / dt_s;
  const double keep = std::exp(-dt_s / config.in_motion_averaging_s);
  smooth_force_ = smooth_time_s_ > 0.0 ? Vector3d(keep * smooth_force_ + (1.0 - keep) * force) : force;
  smooth_time_s_ += dt_s;
  const Vector3d rate = step.increments.dtheta_rad / dt_s;
  const bool marked =
      heads_by_acceleration(config) && track_.add(velocities_.pending(), now_ns, dt_s, rate, force);
  velocities_.add(now_ns, dt_s, rate, force, config.in_motion_averaging_s);
  const bool may_move = config.mode != StartMode::at_rest;
  // A dropped vehicle that only runs smoothly is not at rest: GPS has to say so.
  const bool may_rest =
      config.mode != StartMode::in_motion && (!released || estimate.since(gps_seen_ns_) <= kFreshFix_s);
  const bool late = to_seconds(now_ns - alignment.waiting_since_ns) > config.timeout_s;

  if (may_move && ((can_start_in_motion(in) && start_in_motion(in, estimate)) ||
                   (can_start_under_way(in) && start_under_way(in, estimate)) ||
                   (marked && start_by_acceleration(in, estimate)))) {
    forget_accelerations();
    return true;
  }
  if (!may_rest) {
    if (late) alignment.enter(AlignmentPhase::timed_out, now_ns);
    return false;
  }
  window_.add(dt_s, rate, force);
  const StartConditions c = conditions(in);
  const bool judged = window_.duration_s() >= kLeastWindow_s;
  if (!c.slow || (judged && !c.quiet) || window_.duration_s() > kWindowsKept * config.averaging_s) {
    window_.reset();
    estimate.levelled = estimate.levelled && c.slow && c.quiet;
    alignment.enter(late ? AlignmentPhase::timed_out : AlignmentPhase::waiting, now_ns);
    return false;
  }
  if (!c.window_full) {
    if (judged) alignment.enter(late ? AlignmentPhase::timed_out : AlignmentPhase::averaging, now_ns);
    return false;
  }
  estimate.levelled = true;
  const RestResult rest = window_.result();
  const Eigen::Vector2d tilt = level(rest.force_start_m_s2);
  estimate.state.nav.q_NB = geo::from_rpy(Vector3d(tilt.x(), tilt.y(), 0.0)) * rest.q_start_now;
  alignment.enter(late ? AlignmentPhase::timed_out : AlignmentPhase::coarse, now_ns);
  if (!c.position || !start_at_rest(in, estimate)) return false;
  forget_accelerations();
  return true;
}

StartHeading::Column start_error(const StateIndex& index, bool by_compass) {
  // (GATE-9)
  StartHeading::Column column{};
  column[8] = 1.0;
  const int bias = index.of(Group::heading_bias);
  if (by_compass && bias >= 0) column[static_cast<std::size_t>(bias)] = -1.0;
  return column;
}

void begin_given(const Setup& setup, const InitialState& initial, TimeNs now_ns, Estimate& estimate) {
  estimate.now_ns = now_ns;
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
    const Vector3d lever = geo::vec(setup.config.output_lever_B_m);
    start.nav.position = geo::moved_by(start.nav.position, -(c * lever));
    start.nav.v_N_m_s -= c * geo::cross(estimate.rate_B_rad_s, lever);
  }
  std::array<double, kMaxStates> sigma = setup.initial_sigma;
  for (std::size_t i = 0; i < 3; ++i) {
    sigma[i] = initial.position_sigma_N_m[i];
    sigma[3 + i] = initial.velocity_sigma_N_m_s[i];
    sigma[6 + i] = initial.attitude_sigma_rad[i];
  }
  // A given start may be in the air or deep down: the surface is where the configuration says, or about
  // there.
  const int surface = setup.index.of(Group::surface_altitude);
  if (surface >= 0) start.x[static_cast<std::size_t>(surface)] = setup.config.states.surface_altitude_m;
  estimate.begin(start, sigma);
  estimate.start_heading.begin(start_error(setup.index, false));
}

}  // namespace fathom::estimation

// A start under way: by the course of GPS, or with a compass where a vehicle moves too slowly for its course
// to be a heading, or is out of reach of GPS, or by accelerations where nothing says where it points.
#include <algorithm>
#include <cmath>

#include "estimation/aiding/dvl_velocity.hpp"
#include "estimation/aiding/gps_position.hpp"
#include "estimation/aiding/heading.hpp"
#include "estimation/aiding/usbl_station.hpp"
#include "estimation/alignment/acceleration_start.hpp"
#include "estimation/alignment/moving_start.hpp"
#include "estimation/navigator/start/correlate.hpp"
#include "estimation/navigator/start/starter.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kVelocitySigma_m_s = 0.3;
/// A DVL's velocity this old is still that of the vehicle, but for what it may have gained meanwhile.
constexpr double kSameMotion_s = 0.5;
constexpr double kGain_m_s2 = 0.2;

/// Gravity, less the Coriolis acceleration of the motion.
Vector3d gravity_N_m_s2(const geo::LocalEarth& earth, const Vector3d& v_N_m_s) {
  return earth.gravity_N() - geo::cross(2.0 * earth.earth_rate_N + earth.transport_rate_N(v_N_m_s), v_N_m_s);
}

/// What is wrong with a specific force of one g beyond what the states of the accelerometers are joined to.
double unexplained_force_m_s2(const Setup& setup, double g_m_s2) {
  const ImuConfig& imu = setup.config.imu;
  const double oblique =
      setup.index.has(Group::accel_misalignment) ? 0.0 : g_m_s2 * imu.accel_misalignment_sigma_rad;
  const double stretched = setup.index.has(Group::accel_scale) ? 0.0 : g_m_s2 * imu.accel_scale_sigma;
  return std::hypot(g_m_s2 * setup.config.alignment.tilt_sigma_floor_rad, oblique, stretched);
}

/// (ALN-6): the errors of velocity and attitude have causes in common. The filter's velocity error is the
/// estimate less the truth (KF-4), that of the start the truth less what was found.
void correlate_moving(const Setup& setup, const MovingStart& start, ErrorFilter& filter) {
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) filter.set(3 + i, 6 + k, -start.P_vp(i, k));
    for (int k = 0; k <= i; ++k) {
      filter.set(3 + i, 3 + k, start.P_vv(i, k));
      filter.set(6 + i, 6 + k, start.P_pp(i, k));
    }
  }
  correlate_accelerometers(setup, start.by_accel_bias, start.mean_force_B_m_s2, filter);
  correlate_gyros(setup, start.by_gyro_bias, start.mean_rate_B_rad_s, filter);
}

/// (ALN-6): a heading that was taken by a DVL is off by what the DVL is turned by.
void correlate_dvl(const Setup& setup, const MovingStart& start, ErrorFilter& filter) {
  const int states = setup.index.of(Group::dvl_misalignment);
  if (states < 0) return;
  const auto dvl = std::find_if(setup.config.sensors.begin(), setup.config.sensors.end(),
                                [](const SensorConfig& one) { return one.kind == SourceKind::dvl; });
  if (dvl == setup.config.sensors.end()) return;
  const Matrix3d C_ND =
      geo::to_matrix(start.q_NB) * geo::to_matrix(geo::from_rpy(geo::vec(dvl->mounting_rpy_rad)));
  for (int k = 0; k < 3; ++k) {
    const double variance = filter(states + k, states + k);
    for (int i = 0; i < 3; ++i) filter.set(6 + i, states + k, start.by_heading(i) * C_ND(2, k) * variance);
  }
}

}  // namespace

void Starter::collect_under_way(const Setup& setup, const Estimate& estimate, const Measurement& measurement,
                                const SensorConfig& config) {
  if (const auto* heading = std::get_if<HeadingSample>(&measurement.sample)) {
    const double psi = true_heading(*heading, setup.magnetic_variation_rad()) - config.mounting_rpy_rad[2];
    const AlignmentConfig& alignment = setup.config.alignment;
    if (!(std::abs(psi) < 20.0) || !heading_wanted(alignment, config)) return;
    if (!config.two_antenna && under_way_.two_antenna &&
        estimate.since(under_way_.heading_ns) <= kFreshVelocity_s)
      return;
    under_way_.heading_rad = psi;
    under_way_.heading_sigma_rad = heading_sigma(alignment, config, *heading);
    under_way_.two_antenna = config.two_antenna;
    under_way_.heading_ns = estimate.now_ns;
  } else if (const auto* dvl = std::get_if<DvlSample>(&measurement.sample)) {
    const Vector3d v_D = geo::vec(dvl->velocity_D_m_s);
    const bool sound = v_D.allFinite() && v_D.cwiseAbs().maxCoeff() < kMostDvlSpeed_m_s;
    if (dvl->mode != DvlMode::bottom || !sound) return;
    under_way_.dvl_velocity_B_m_s = geo::to_matrix(geo::from_rpy(geo::vec(config.mounting_rpy_rad))) * v_D;
    under_way_.dvl_lever_B_m = geo::vec(config.lever_B_m);
    const double own = *std::max_element(config.sigma.begin(), config.sigma.end());
    under_way_.dvl_sigma_m_s = sigma_of(std::hypot(own, config.proportional_sigma * v_D.norm()),
                                        dvl->sigma_m_s, config.use_sample_sigma);
    under_way_.dvl_ns = estimate.now_ns;
  } else if (const auto* depth = std::get_if<DepthSample>(&measurement.sample)) {
    if (!(std::abs(depth->depth_m) < kMostAltitude_m)) return;
    under_way_.depth_m = depth->depth_m;
    under_way_.depth_ns = estimate.now_ns;
  } else if (const auto* usbl = std::get_if<UsblSample>(&measurement.sample)) {
    const double surface_m = setup.config.states.surface_altitude_m;
    const auto place = usbl_place(config, *usbl, surface_m);
    if (!place) return;
    const UsblNoise noise(config, *usbl);
    const double sigma_m =
        known(usbl->range_m) ? std::hypot(noise.range_m, usbl->range_m * noise.angle_rad) : noise.range_m;
    under_way_.usbl_agrees = agrees(setup, estimate, *place, sigma_m);
    under_way_.usbl_latitude_rad = place->latitude_rad;
    under_way_.usbl_longitude_rad = place->longitude_rad;
    under_way_.usbl_depth_m = surface_m - place->altitude_m;
    under_way_.usbl_sigma_m = sigma_m;
    under_way_.usbl_lever_B_m = geo::vec(config.lever_B_m);
    under_way_.usbl_turned_N_m = usbl_turned_N_m(config, *usbl, *place, surface_m);
    under_way_.usbl_ns = estimate.now_ns;
  }
}

Starter::Course Starter::course(const Setup& setup, TimeNs stamp_ns, const Vector3d& v_N_m_s,
                                const Vector3d& sigma_m_s, const Vector3d& rate_B_rad_s) const {
  // (ALN-6)
  const double noise_m_s = sigma_m_s.head<2>().maxCoeff();
  const double age_s = to_seconds(stamp_ns - under_way_.dvl_ns);
  Course out;
  if (under_way_.dvl_ns != 0 && std::abs(age_s) <= kSameMotion_s) {
    const Vector3d measured_B =
        under_way_.dvl_velocity_B_m_s - geo::cross(rate_B_rad_s, under_way_.dvl_lever_B_m);
    const double speed_m_s = measured_B.norm();
    const double noise_B_m_s = std::hypot(under_way_.dvl_sigma_m_s, kGain_m_s2 * age_s);
    if (speed_m_s > 3.0 * noise_B_m_s) {
      out.axis_B = geo::to_matrix(geo::exp(-age_s * rate_B_rad_s)) * measured_B / speed_m_s;
      out.sigma_rad = std::hypot(setup.config.states.dvl_misalignment_sigma_rad, noise_B_m_s / speed_m_s);
      out.whole_sigma_rad = std::hypot(out.sigma_rad, noise_m_s / v_N_m_s.head<2>().norm());
      out.by_dvl = true;
      return out;
    }
  }
  const double speed_m_s = v_N_m_s.head<2>().norm();
  out.sigma_rad = std::hypot(setup.config.alignment.in_motion_heading_sigma_rad,
                             setup.config.states.current_sigma_m_s / speed_m_s);
  out.whole_sigma_rad = std::hypot(out.sigma_rad, noise_m_s / speed_m_s);
  return out;
}

double Starter::course_sigma_rad(const StartInputs& in) const {
  if (!(in.estimate.since(gps_seen_ns_) <= kFreshVelocity_s) || !known(gps_speed_m_s_)) return kUnknown;
  const Vector3d sigma = velocities_.newest_sigma_m_s();
  return course(in.setup, gps_seen_ns_, gps_velocity_N_, sigma, in.estimate.rate_B_rad_s).whole_sigma_rad;
}

bool Starter::hears_compass(const StartInputs& in) const {
  const HeadingSource source = heading_source(in.setup);
  return source != HeadingSource::given && source != HeadingSource::gyrocompass &&
         in.estimate.since(under_way_.heading_ns) <= kFreshVelocity_s;
}

bool Starter::can_start_in_motion(const StartInputs& in) const {
  if (!(in.estimate.since(gps_seen_ns_) <= 1.0) || !velocities_.complete()) return false;
  if (goes_fast()) return true;
  if (hears_compass(in)) return false;
  // The first velocity must not be one of rest: an outlier alone is no motion.
  const VelocityMark& first = velocities_.first();
  const double noise_m_s = first.sigma_m_s.head<2>().maxCoeff();
  if (!(noise_m_s <= kCoarsestHeading_rad * first.v_N_m_s.head<2>().norm())) return false;
  const VelocityMark& last = velocities_.last();
  const Course found = course(in.setup, gps_seen_ns_, last.v_N_m_s, last.sigma_m_s, last.rate_B_rad_s);
  return found.whole_sigma_rad <= kCoarsestHeading_rad;
}

bool Starter::start_in_motion(const StartInputs& in, Estimate& estimate) const {
  return start_moving_by(in, std::nullopt, in.setup.config.alignment.in_motion_heading_sigma_rad, estimate);
}

bool Starter::start_moving_by(const StartInputs& in, std::optional<double> heading_rad,
                              double heading_sigma_rad, Estimate& estimate) const {
  // (ALN-6)
  const Setup& setup = in.setup;
  const ImuConfig& imu = setup.config.imu;
  const geo::LocalEarth earth(gps_position_);
  const Vector3d v = velocities_.last().v_N_m_s;
  MovingStartInputs inputs;
  inputs.gravity_N_m_s2 = gravity_N_m_s2(earth, v);
  inputs.lever_B_m = gps_lever_B_m_;
  inputs.heading_rad = heading_rad;
  inputs.heading_sigma_rad = heading_sigma_rad;
  bool by_dvl = false;
  const bool by_speed = goes_fast();
  if (!heading_rad && !by_speed) {
    const VelocityMark& last = velocities_.last();
    const Course found = course(setup, gps_seen_ns_, last.v_N_m_s, last.sigma_m_s, last.rate_B_rad_s);
    inputs.course_axis_B = found.axis_B;
    inputs.joint_course = true;
    by_dvl = found.by_dvl;
    inputs.heading_sigma_rad = found.sigma_rad;
  }
  inputs.force_sigma_m_s2 = unexplained_force_m_s2(setup, earth.gravity_m_s2);
  inputs.accel_bias_sigma_m_s2 = imu.accel_bias_sigma_m_s2;
  const auto found = start_moving(velocities_, inputs);
  if (!found) return false;

  begin_moving(in, *found, estimate);
  if (heading_rad) estimate.start_heading.begin(start_error(setup.index, !under_way_.two_antenna));
  if (heading_rad && under_way_.two_antenna) correlate_antennas(setup, found->by_heading, estimate.filter);
  if (by_dvl) correlate_dvl(setup, *found, estimate.filter);
  return true;
}

void Starter::begin_moving(const StartInputs& in, const MovingStart& found, Estimate& estimate) const {
  FilterState start;
  start.nav.q_NB = found.q_NB;
  start.nav.v_N_m_s = found.v_N_m_s;
  const StartPlace at = *place(in);
  start.nav.position = geo::moved_by(at.position, at.age_s * found.v_N_m_s);
  begin(in, at, start, in.setup.initial_sigma, estimate);
  correlate_moving(in.setup, found, estimate.filter);
}

bool Starter::start_by_acceleration(const StartInputs& in, Estimate& estimate) {
  // (ALN-24)
  acceleration_heading_sigma_rad_ = kUnknown;
  if (hears_compass(in) || !(in.estimate.since(gps_seen_ns_) <= kFreshVelocity_s)) return false;
  const ImuConfig& imu = in.setup.config.imu;
  const geo::LocalEarth earth(gps_position_);
  const double g = earth.gravity_m_s2;
  AccelerationStartInputs inputs;
  inputs.gravity_N_m_s2 = gravity_N_m_s2(earth, track_.newest().v_N_m_s);
  inputs.lever_B_m = gps_lever_B_m_;
  inputs.velocity_random_walk_m_s_sqrt_s = imu.velocity_random_walk_m_s_sqrt_s;
  inputs.angle_random_walk_rad_sqrt_s = imu.angle_random_walk_rad_sqrt_s;
  inputs.accel_bias_sigma_m_s2 = imu.accel_bias_sigma_m_s2;
  inputs.accel_shape_sigma_m_s2 = g * std::hypot(imu.accel_scale_sigma, imu.accel_misalignment_sigma_rad,
                                                 in.setup.config.alignment.tilt_sigma_floor_rad);
  inputs.unexplained_force_sigma_m_s2 = unexplained_force_m_s2(in.setup, g);
  inputs.gyro_bias_sigma_rad_s = imu.gyro_bias_sigma_rad_s;
  inputs.turn_error_sigma = std::hypot(imu.gyro_scale_sigma, imu.gyro_misalignment_sigma_rad);
  inputs.latency_sigma_s = in.setup.config.states.gps_latency_sigma_s;
  const auto found = start_by_accelerations(track_, inputs);
  if (!found) return false;
  acceleration_heading_sigma_rad_ = found->sigma_N_rad.z();
  if (!(found->sigma_N_rad.maxCoeff() <= kCoarsestByAcceleration_rad)) return false;
  begin_moving(in, found->start, estimate);
  return true;
}

bool Starter::can_start_under_way(const StartInputs& in) const {
  const AlignmentConfig& config = in.setup.config.alignment;
  if (!hears_compass(in)) return false;
  if (smooth_time_s_ < config.in_motion_averaging_s) return false;
  const bool gps = in.estimate.since(gps_seen_ns_) <= kFreshVelocity_s && known(gps_speed_m_s_);
  const bool dvl = in.estimate.since(under_way_.dvl_ns) <= kFreshVelocity_s;
  // At rest the levelling of a longer window is the better start.
  const double speed_m_s = gps ? gps_speed_m_s_ : dvl ? under_way_.dvl_velocity_B_m_s.norm() : 0.0;
  if (gps && !velocities_.complete()) return false;
  return speed_m_s > config.max_speed_m_s && place(in).has_value();
}

bool Starter::start_under_way(const StartInputs& in, Estimate& estimate) const {
  if (velocities_.complete())
    return start_moving_by(in, under_way_.heading_rad, under_way_.heading_sigma_rad, estimate);
  // (ALN-8): heading from the compass, level from the mean specific force, velocity from the DVL turned by
  // that attitude; position from an order or the configuration, else from an acoustic fix.
  const AlignmentConfig& config = in.setup.config.alignment;
  const Eigen::Vector2d tilt = level(smooth_force_);
  FilterState start;
  start.nav.q_NB = geo::from_rpy(Vector3d(tilt.x(), tilt.y(), under_way_.heading_rad));
  const Matrix3d c = geo::to_matrix(start.nav.q_NB);
  start.nav.v_N_m_s = c * under_way_.dvl_velocity_B_m_s;
  const StartPlace at = *place(in);
  start.nav.position = geo::moved_by(at.position, at.age_s * start.nav.v_N_m_s);
  std::array<double, kMaxStates> sigma = in.setup.initial_sigma;
  const double turned = start.nav.v_N_m_s.norm() * under_way_.heading_sigma_rad;
  for (std::size_t i = 0; i < 3; ++i) sigma[3 + i] = std::hypot(kVelocitySigma_m_s, turned);
  sigma[6] = sigma[7] = config.in_motion_tilt_sigma_rad;
  sigma[8] = std::hypot(under_way_.heading_sigma_rad, 0.5 * config.in_motion_tilt_sigma_rad);
  begin(in, at, start, sigma, estimate);
  if (under_way_.two_antenna) correlate_antennas(in.setup, kByHeading, estimate.filter);
  StartHeading::Column column = start_error(in.setup.index, !under_way_.two_antenna);
  column[3] = start.nav.v_N_m_s.y();
  column[4] = -start.nav.v_N_m_s.x();
  estimate.start_heading.begin(column);
  return true;
}

}  // namespace fathom::estimation

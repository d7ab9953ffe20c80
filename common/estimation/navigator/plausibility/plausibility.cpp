#include "estimation/navigator/plausibility/plausibility.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"
#include "estimation/aiding/gps_position.hpp"
#include "estimation/aiding/heading.hpp"
#include "geo/wgs84.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kDownMemory_s = 2.0;
constexpr double kQuiet_rad_s = 0.35;
constexpr double kAlong = 0.97;  // 14 degrees: a vehicle that stands on end has no heading
constexpr double kFelt_s = 1.0;
constexpr double kPair_s = 1.0;
constexpr double kLongestPair_s = 8.0;
constexpr double kSteady_s = 4.0;
constexpr double kTogether_s = 0.3;
constexpr double kSlowest_m_s = 0.5;
constexpr double kCompassTurn = 0.2;  // of a turn, that tilt and deviation take or add
constexpr double kCourseTurn = 0.4;   // and slip and bank
constexpr double kWayShare = 0.15;    // of a way or a speed: scale, lever, the curve between two readings
constexpr double kLever_m_s = 0.1;    // that a lever adds in a turn
constexpr double kAntenna_m = 0.5;    // and one that is not where it is said to be
constexpr double kStandsOut = 5.0;
constexpr double kLongestTrack_s = 30.0;
constexpr double kSilent_s = 1.5;   // longer, nobody knows the way between two velocities
constexpr double kTilt_rad = 0.02;  // of the smoothed force: 0.2 m/s^2 that last for seconds

/// Before that a pair goes on.
bool stands_out(double a, double b, double noise) {
  return std::max(std::abs(a), std::abs(b)) >= kStandsOut * noise;
}

}  // namespace

void Plausibility::interrupt() {
  compass_.from_ns = course_.from_ns = track_.from_ns = track_.last_ns = depth_.from_ns = 0;
  felt_s_ = felt_rate_rad_s_ = 0.0;
  felt_m_s_.setZero();
  felt_turn_rad_.setZero();
  axes_.interrupt();
  tilts_.interrupt();
  in_g_s_ = downwards_s_ = upwards_s_ = along_x_s_ = along_y_s_ = 0.0;
}

void Plausibility::add(const Setup& setup, const ImuStep& step, TimeNs now_ns) {
  const double dt_s = step.increments.dt_s;
  if (step.gap_s > 0.0 || step.fault != ImuFault::none || !(dt_s > 0.0)) {
    if (step.gap_s > 0.0) interrupt();
    if (step.fault != ImuFault::none) tilts_.interrupt();
    return;
  }
  interval_s_ += dt_s;
  intervals_ += 1.0;
  slots_ += std::max(1.0, std::round(dt_s * setup.config.imu.nominal_rate_hz));
  if (interval_s_ > 4.0 * kHeard_s) {
    interval_s_ *= 0.5;
    intervals_ *= 0.5;
    slots_ *= 0.5;
  }
  const Vector3d force = step.increments.dv_m_s / dt_s;
  const double keep = std::exp(-dt_s / kDownMemory_s);
  down_B_ = down_B_.isZero(0.0) ? Vector3d(-force) : Vector3d(keep * down_B_ - (1.0 - keep) * force);
  const double length = down_B_.norm();
  if (length > 0.0) {
    const Vector3d down = down_B_ / length;
    const double turned = down.dot(step.increments.dtheta_rad);
    compass_.turned_rad += turned;
    course_.turned_rad += turned;
    if (dvl_ns_ != 0) {
      const double way = dt_s * down.dot(dvl_velocity_B_m_s_);
      depth_.way_m += way;
      depth_.path_m += dt_s * dvl_velocity_B_m_s_.norm();
    }
  }
  felt_turn_rad_ += step.increments.dtheta_rad;
  tilts_.add(step.increments.dv_m_s, step.increments.dtheta_rad, dt_s);
  feel(setup, dt_s, force, step.increments.dtheta_rad.norm() / dt_s, now_ns);
}

void Plausibility::feel(const Setup& setup, double dt_s, const Vector3d& force_B_m_s2, double rate_rad_s,
                        TimeNs now_ns) {
  felt_s_ += dt_s;
  felt_m_s_ += dt_s * force_B_m_s2;
  felt_rate_rad_s_ = std::max(felt_rate_rad_s_, rate_rad_s);
  if (felt_s_ < kFelt_s) return;
  // What an acceleration may add to gravity within a second; a fall is not looked for where there is none.
  const Vector3d mean = felt_m_s_ / felt_s_;
  const double length = mean.norm();
  const bool falls = setup.config.alignment.mode == StartMode::air_drop;
  const double spread = 0.1 + 3.0 * (setup.config.imu.accel_bias_sigma_m_s2 / kStandardGravity_m_s2 +
                                     setup.config.imu.accel_scale_sigma);
  const bool in_g = !falls && std::abs(length - 1.0) < spread;
  const bool quiet = felt_rate_rad_s_ < kQuiet_rad_s;
  const bool stands = !falls && quiet && length > 0.5;
  in_g_s_ = in_g ? in_g_s_ + felt_s_ : 0.0;
  downwards_s_ = stands && mean.z() > 0.7 * length ? downwards_s_ + felt_s_ : 0.0;
  upwards_s_ = stands && length > 5.0 && -mean.z() > 0.7 * length ? upwards_s_ + felt_s_ : 0.0;
  const bool along_x = stands && std::abs(mean.x()) > kAlong * length;
  const bool along_y = stands && std::abs(mean.y()) > kAlong * length;
  along_x_s_ = along_x ? along_x_s_ + felt_s_ : 0.0;
  along_y_s_ = along_y ? along_y_s_ + felt_s_ : 0.0;
  const bool slow = speed_ns_ != 0 && to_seconds(now_ns - speed_ns_) <= kSteady_s;
  gain_.close(now_ns);
  axes_.add(-mean, felt_turn_rad_, felt_s_,
            {.speed_m_s = slow ? speed_m_s_ : kUnknown,
             .acceleration_N_m_s2 = gain_.acceleration_N_m_s2,
             .variance_m2_s4 = gain_.variance_m2_s4});
  felt_s_ = felt_rate_rad_s_ = 0.0;
  felt_turn_rad_.setZero();
  felt_m_s_.setZero();
  judge(setup);
}

void Plausibility::measured(const Setup& setup, const Measurement& measurement,
                            const TrustedAttitude* attitude, TimeNs now_ns) {
  if (measurement.command) return;
  const SensorConfig& config = setup.sensor(measurement.sensor);
  if (const auto* gps = std::get_if<GpsSample>(&measurement.sample))
    take(setup, config, *gps, attitude, now_ns);
  if (const auto* heading = std::get_if<HeadingSample>(&measurement.sample))
    take(setup, config, *heading, now_ns);
  if (const auto* dvl = std::get_if<DvlSample>(&measurement.sample)) take(config, *dvl, now_ns);
  if (const auto* depth = std::get_if<DepthSample>(&measurement.sample)) take(config, *depth, now_ns);
}

void Plausibility::turn(Turn& turn, double angle_rad, double sigma_rad, double share, TimeNs now_ns) {
  const double lasted_s = turn.from_ns == 0 ? kUnknown : to_seconds(now_ns - turn.from_ns);
  if (lasted_s < kPair_s) return;
  if (lasted_s <= kLongestPair_s) {
    const double by = geo::wrap_pi(angle_rad - turn.angle_rad);
    if (!stands_out(turn.turned_rad, by, sigma_rad)) return;
    turn.fit.add(turn.turned_rad, by, sigma_rad, share);
  }
  turn.from_ns = now_ns;
  turn.angle_rad = angle_rad;
  turn.turned_rad = 0.0;
}

void Plausibility::take(const Setup& setup, const SensorConfig& config, const HeadingSample& heading,
                        TimeNs now_ns) {
  const double psi = true_heading(heading, setup.magnetic_variation_rad()) - config.mounting_rpy_rad[2];
  if (std::abs(psi) < 20.0) {
    heading_rad_ = psi;
    heading_ns_ = now_ns;
  }
  // The turn is the same from whatever north.
  const double reading = heading.heading_rad;
  if (!(std::abs(reading) < 20.0)) return;
  turn(compass_, reading, std::hypot(config.sigma[0], setup.config.alignment.compass_sigma_rad), kCompassTurn,
       now_ns);
}

void Plausibility::take(const SensorConfig& config, const DvlSample& dvl, TimeNs now_ns) {
  const Vector3d v_D = geo::vec(dvl.velocity_D_m_s);
  if (dvl.mode != DvlMode::bottom || !v_D.allFinite()) return;
  dvl_velocity_B_m_s_ = geo::to_matrix(geo::from_rpy(geo::vec(config.mounting_rpy_rad))) * v_D;
  dvl_ns_ = speed_ns_ = now_ns;
  speed_m_s_ = dvl_velocity_B_m_s_.norm();
}

void Plausibility::take(const SensorConfig& config, const DepthSample& depth, TimeNs now_ns) {
  if (!std::isfinite(depth.depth_m)) return;
  const double lasted_s = depth_.from_ns == 0 ? kUnknown : to_seconds(now_ns - depth_.from_ns);
  if (lasted_s < 2.0 * kPair_s) return;
  const bool runs = dvl_ns_ != 0 && to_seconds(now_ns - dvl_ns_) <= kPair_s;
  if (lasted_s <= kLongestPair_s && runs) {
    const double noise = std::hypot(1.4 * config.sigma[0], kTilt_rad * depth_.path_m);
    if (!stands_out(depth_.way_m, depth.depth_m - depth_.depth_m, noise)) return;
    depth_.fit.add(depth_.way_m, depth.depth_m - depth_.depth_m, noise, kWayShare);
  }
  depth_.from_ns = now_ns;
  depth_.depth_m = depth.depth_m;
  depth_.way_m = depth_.path_m = 0.0;
}

void Plausibility::follow(const SensorConfig& config, const GpsSample& gps, const Vector2d& v_N_m_s,
                          double noise_m_s, TimeNs now_ns) {
  if (track_.last_ns != 0 && to_seconds(now_ns - track_.last_ns) > kSilent_s) track_.from_ns = 0;
  if (track_.last_ns != 0)
    track_.way_m += 0.5 * to_seconds(now_ns - track_.last_ns) * (track_.velocity_m_s + v_N_m_s);
  track_.velocity_m_s = v_N_m_s;
  track_.last_ns = now_ns;
  const double lasted_s = track_.from_ns == 0 ? kUnknown : to_seconds(now_ns - track_.from_ns);
  if (lasted_s <= kLongestTrack_s) {
    // The longer the way, the less the noise of its ends says.
    const double sigma_m = sigma_of(config.sigma[0], gps.position_sigma_N_m[0], config.use_sample_sigma);
    const double noise_m = std::hypot(1.4 * std::max(sigma_m, 0.1), kPair_s * noise_m_s);
    const Vector2d way = geo::difference_N({track_.latitude_rad, track_.longitude_rad, 0.0},
                                           {gps.latitude_rad, gps.longitude_rad, 0.0})
                             .head<2>();
    if (lasted_s < 2.0 * kPair_s || std::max(way.norm(), track_.way_m.norm()) < kStandsOut * noise_m) return;
    track_.fit.add(track_.way_m, way, noise_m, kWayShare);
  }
  track_.from_ns = now_ns;
  track_.latitude_rad = gps.latitude_rad;
  track_.longitude_rad = gps.longitude_rad;
  track_.way_m.setZero();
}

void Plausibility::Gain::close(TimeNs now_ns) {
  const double lasted_s = to_seconds(newest_ns - from_ns);
  if (from_ns == 0 || to_seconds(now_ns - newest_ns) > kSteady_s || lasted_s > kSteady_s) {
    acceleration_N_m_s2.setZero();
    variance_m2_s4 = 0.0;
  } else if (lasted_s > 0.0) {
    acceleration_N_m_s2 = (newest_N_m_s - from_N_m_s) / lasted_s;
    variance_m2_s4 = 4.0 * noise_m_s * noise_m_s / (lasted_s * lasted_s);
  }
  from_ns = newest_ns;
  from_N_m_s = newest_N_m_s;
}

void Plausibility::take(const Setup& setup, const SensorConfig& config, const GpsSample& gps,
                        const TrustedAttitude* attitude, TimeNs now_ns) {
  const Vector2d v(gps.velocity_N_m_s[0], gps.velocity_N_m_s[1]);
  if (!is_fixed(config, gps) || !v.allFinite() || !(v.norm() < 1000.0)) return;
  if (!is_on_earth(gps.latitude_rad, gps.longitude_rad)) return;
  const double noise_m_s =
      std::max(sigma_of(config.velocity_sigma_m_s[0], gps.velocity_sigma_N_m_s[0], config.use_sample_sigma),
               sigma_of(config.velocity_sigma_m_s[1], gps.velocity_sigma_N_m_s[1], config.use_sample_sigma));
  const double speed = v.norm();
  speed_m_s_ = speed;
  speed_ns_ = now_ns;
  gain_.newest_N_m_s = v;
  gain_.newest_ns = now_ns;
  gain_.noise_m_s = noise_m_s;

  if (config.use_velocity) follow(config, gps, v, noise_m_s, now_ns);
  if (config.use_velocity && attitude != nullptr) {
    const double down_m_s = std::abs(gps.velocity_N_m_s[2]) < 1000.0 ? gps.velocity_N_m_s[2] : 0.0;
    tilts_.measured({.v_N_m_s = {v.x(), v.y(), down_m_s},
                     .noise_m_s = noise_m_s,
                     .lever_m = kAntenna_m + geo::vec(config.lever_B_m).norm(),
                     .attitude = *attitude});
  }
  if (speed > std::max(kSlowest_m_s, 10.0 * noise_m_s)) {
    const double sigma = std::hypot(1.4 * noise_m_s / speed, setup.config.alignment.compass_sigma_rad);
    turn(course_, std::atan2(v.y(), v.x()), sigma, kCourseTurn, now_ns);
  } else {
    course_.from_ns = 0;
  }

  if (dvl_ns_ == 0 || to_seconds(now_ns - dvl_ns_) > kTogether_s) return;
  const Vector2d d = dvl_velocity_B_m_s_.head<2>();
  const double noise = std::hypot(noise_m_s, kLever_m_s);
  speed_.add(d.norm(), speed, noise, kWayShare);
  if (heading_ns_ == 0 || to_seconds(now_ns - heading_ns_) > kTogether_s) return;
  const double c = std::cos(heading_rad_);
  const double s = std::sin(heading_rad_);
  ground_.add(Vector2d(c * d.x() - s * d.y(), s * d.x() + c * d.y()), v, noise, kWayShare);
  mirror_.add(Vector2d(c * d.x() + s * d.y(), s * d.x() - c * d.y()), v, noise, kWayShare);
}

}  // namespace fathom::estimation

#include "estimation/navigator/start/descent.hpp"

#include <algorithm>
#include <cmath>

#include "estimation/hydro/shaft_speed.hpp"
#include "geo/wgs84.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// A heading known worse than this is none: the filter could not be linearised
// about it.
constexpr double kHeadingLeft_rad = 0.79;
// What an instrument may say at all.
constexpr double kDeepest_m = 12000.0;

}  // namespace

void Descent::start(const Setup& setup, const InitialState& initial, const Estimate& estimate,
                    AlignmentWatch& alignment) {
  DropConfig config = setup.drop_config();
  config.tilt_sigma_rad = std::max(initial.attitude_sigma_rad[0], initial.attitude_sigma_rad[1]);
  config.heading_sigma_rad = initial.attitude_sigma_rad[2];
  fall_.covariance.setZero();
  for (std::size_t i = 0; i < 3; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    fall_.covariance(at, at) = std::pow(initial.position_sigma_N_m[i], 2);
    fall_.covariance(at + 3, at + 3) = std::pow(initial.velocity_sigma_N_m_s[i], 2);
  }
  begin(config, estimate, alignment);
}

void Descent::restart(const Setup& setup, double tilt_sigma_rad, double unobserved_s,
                      const Estimate& estimate, AlignmentWatch& alignment) {
  DropConfig config = setup.drop_config();
  config.tilt_sigma_rad = tilt_sigma_rad;
  config.heading_sigma_rad = rpy_sigma_rad(setup, estimate).z();
  if (!fall_.aligning) {
    for (int i = 0; i < 6; ++i)
      for (int k = 0; k < 6; ++k) fall_.covariance(i, k) = estimate.filter(i, k);
    fall_.carried_s = fall_.s;
  }
  fall_.s += unobserved_s;
  carry_covariance(setup);
  if (fall_.aligning) {
    // (ALN-16) No correction turns these integrals any more.
    const Eigen::Matrix<double, 6, 3> of_attitude = arm(unobserved_s);
    fall_.covariance += of_attitude * drop_.attitude_covariance() * of_attitude.transpose();
  }
  begin(config, estimate, alignment);
}

void Descent::begin(const DropConfig& config, const Estimate& estimate, AlignmentWatch& alignment) {
  drop_ = DropAlignment(config);
  drop_.start(estimate.state.nav.q_NB);
  fall_.aligning = fall_.released = true;
  fall_.regained = false;
  fall_.dv_N.setZero();
  fall_.dp_N.setZero();
  fall_.s = fall_.carried_s = 0.0;
  alignment.hold_since_ns = 0;
  alignment.enter(drop_.phase(), estimate.now_ns);
}

bool Descent::resume(const Setup& setup, double gap_s, Estimate& estimate, AlignmentWatch& alignment) {
  // (ALN-19)
  if (!fall_.released || !estimate.navigating) return false;
  const GapSigma sigma(setup.config.imu, gap_s);
  const Vector3d rpy = rpy_sigma_rad(setup, estimate);
  if (std::hypot(rpy.z(), sigma.angle_rad) > kHeadingLeft_rad) return false;
  restart(setup, std::max(rpy.x(), rpy.y()), gap_s, estimate, alignment);
  drop_.lose();
  estimate.widen(sigma);
  widen(setup, sigma);
  fall_.regained = true;
  alignment.enter(drop_.phase(), estimate.now_ns);
  return true;
}

void Descent::widen(const Setup& setup, const GapSigma& sigma) {
  drop_.widen(sigma.angle_rad, sigma.velocity_m_s, sigma.position_m);
  carry_covariance(setup);
  fall_.covariance.diagonal().head<3>().array() += sigma.position_m * sigma.position_m;
  fall_.covariance.diagonal().tail<3>().array() += sigma.velocity_m_s * sigma.velocity_m_s;
}

void Descent::carry_covariance(const Setup& setup) {
  // A constant velocity error moves the position; an accelerometer bias moves
  // both.
  const double t = fall_.s - fall_.carried_s;
  fall_.carried_s = fall_.s;
  Eigen::Matrix<double, 6, 6> phi = Eigen::Matrix<double, 6, 6>::Identity();
  phi.topRightCorner<3, 3>() = t * Matrix3d::Identity();
  fall_.covariance = (phi * fall_.covariance * phi.transpose()).eval();
  const double bias = setup.config.air_drop.accel_sigma_m_s2;
  Eigen::Matrix<double, 6, 3> g;
  g << 0.5 * t * t * bias * Matrix3d::Identity(), t * bias * Matrix3d::Identity();
  fall_.covariance += g * g.transpose();
}

Eigen::Matrix<double, 6, 3> Descent::arm(double further_s) const {
  Eigen::Matrix<double, 6, 3> out;
  out << geo::skew(fall_.dp_N + further_s * fall_.dv_N), geo::skew(fall_.dv_N);
  return out;
}

void Descent::place(const Setup& setup, int axes, double sigma_m) {
  carry_covariance(setup);
  for (int i = 0; i < axes; ++i) {
    fall_.covariance.row(i).setZero();
    fall_.covariance.col(i).setZero();
    fall_.covariance(i, i) = sigma_m * sigma_m;
    fall_.dp_N(i) = 0.0;  // the new position does not hang on the attitude of the fall
  }
}

void Descent::turn(const Vector3d& rotation_N_rad, Estimate& estimate) {
  // (ALN-16)
  const Matrix3d rotation = geo::to_matrix(geo::exp(rotation_N_rad)) - Matrix3d::Identity();
  const Vector3d dv = rotation * fall_.dv_N;
  const Vector3d dp = rotation * fall_.dp_N;
  estimate.state.nav.v_N_m_s += dv;
  estimate.state.nav.position = geo::moved_by(estimate.state.nav.position, dp);
  fall_.dv_N += dv;
  fall_.dp_N += dp;
  estimate.state.nav.q_NB = drop_.q_NB();
}

void Descent::advance(const Setup& setup, const ImuStep& step, Estimate& estimate,
                      AlignmentWatch& alignment) {
  const double dt_s = to_seconds(step.to_ns - step.from_ns);
  if (step.gap_s > 0.0) drop_.interrupt(StabilityReset::gap);
  if (step.fault == ImuFault::not_finite) drop_.interrupt(StabilityReset::not_finite);
  if (step.fault == ImuFault::stale) drop_.interrupt(StabilityReset::stale);
  if (!(dt_s > 0.0)) return;
  const NavSolution& nav = estimate.state.nav;
  // The attitude is that of the end of the step.
  const Matrix3d c = geo::to_matrix(nav.q_NB * geo::exp(-0.5 * dt_s * estimate.rate_B_rad_s));
  const Vector3d force_N = c * estimate.force_B_m_s2;
  fall_.dp_N += dt_s * fall_.dv_N + 0.5 * dt_s * dt_s * force_N;
  fall_.dv_N += dt_s * force_N;
  fall_.s += dt_s;

  DropStep in;
  in.dt_s = dt_s;
  in.rate_IB_B_rad_s = estimate.rate_B_rad_s;
  in.force_B_m_s2 = estimate.force_B_m_s2;
  in.earth_rate_N_rad_s = geo::earth_rate_N(nav.position.latitude_rad);
  in.rate_IN_N_rad_s = in.earth_rate_N_rad_s + geo::transport_rate_N(nav.position, nav.v_N_m_s);
  in.g_m_s2 = geo::gravity(nav.position.latitude_rad, nav.position.altitude_m);
  turn(drop_.add(in), estimate);
  alignment.enter(drop_.phase(), estimate.now_ns);
  if (drop_.phase() == AlignmentPhase::aligned) hand_over(setup, estimate, alignment);
}

std::optional<Judgement> Descent::feed(const Setup& setup, const Measurement& measurement,
                                       Estimate& estimate) {
  Judgement out;
  const SensorConfig& config = setup.sensor(measurement.sensor);
  if (const auto* depth = std::get_if<DepthSample>(&measurement.sample)) {
    if (!(std::abs(depth->depth_m) < kDeepest_m)) {
      out.kind = VerdictKind::out_of_range;
      return out;
    }
    const double lever_m = (geo::to_matrix(drop_.q_NB()) * geo::vec(config.lever_B_m)).z();
    turn(drop_.add_depth(depth->depth_m - lever_m), estimate);
  } else if (const auto* propulsion = std::get_if<PropulsionSample>(&measurement.sample)) {
    if (!believable_rpm(propulsion->rpm)) {
      out.kind = VerdictKind::out_of_range;
      return out;
    }
    turn(drop_.add_rpm(propulsion->rpm), estimate);
  } else {
    return std::nullopt;
  }
  out.kind = VerdictKind::used;
  out.model = "in_motion_alignment";
  return out;
}

void Descent::hand_over(const Setup& setup, Estimate& estimate, AlignmentWatch& alignment) {
  // (ALN-17)
  fall_.aligning = false;
  carry_covariance(setup);
  estimate.forget_covariance(setup.initial_sigma);
  const Matrix3d attitude = drop_.attitude_covariance();
  const Eigen::Matrix<double, 6, 3> turns = arm();
  Eigen::Matrix<double, 6, 3> cross = turns * attitude;
  Eigen::Matrix<double, 6, 6> motion = fall_.covariance + cross * turns.transpose();
  const TiltFilter& fine = drop_.filter();
  const int accel = setup.index.of(Group::accel_bias);
  const auto fine_accel = fine.covariance().block<3, 3>(TiltFilter::kAccel, TiltFilter::kAccel);
  const auto fine_tilt = fine.covariance().block<3, 3>(TiltFilter::kPhi, TiltFilter::kAccel);
  Eigen::Matrix<double, 6, 3> motion_accel = turns * fine_tilt;
  if (fall_.regained) {
    // (ALN-19) The velocity of before the gap is of no use; that through the
    // water turns with the heading.
    const auto& p = fine.covariance();
    const auto fine_v = p.block<3, 3>(TiltFilter::kVelocity, TiltFilter::kVelocity);
    const auto fine_v_phi = p.block<3, 3>(TiltFilter::kVelocity, TiltFilter::kPhi);
    const Matrix3d turned = geo::skew(fine.v_N_m_s());
    const Matrix3d v_phi = turned * attitude - fine_v_phi;
    const double current = setup.config.states.current_sigma_m_s;
    estimate.state.nav.v_N_m_s = fine.v_N_m_s();
    motion.topRightCorner<3, 3>() = turns.topRows<3>() * v_phi.transpose();
    motion.bottomLeftCorner<3, 3>() = motion.topRightCorner<3, 3>().transpose();
    motion.bottomRightCorner<3, 3>() = v_phi * turned.transpose() - turned * fine_v_phi.transpose() + fine_v +
                                       current * current * Matrix3d::Identity();
    cross.bottomRows<3>() = v_phi;
    motion_accel.bottomRows<3>() =
        turned * fine_tilt - p.block<3, 3>(TiltFilter::kVelocity, TiltFilter::kAccel);
  }
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k <= i; ++k) estimate.filter.set(i, k, motion(i, k));
    for (int k = 0; k < 3; ++k) {
      estimate.filter.set(i, 6 + k, cross(i, k));
      estimate.filter.set(i, accel + k, motion_accel(i, k));
    }
  }
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k <= i; ++k) {
      estimate.filter.set(6 + i, 6 + k, attitude(i, k));
      estimate.filter.set(accel + i, accel + k, fine_accel(i, k));
    }
    for (int k = 0; k < 3; ++k) estimate.filter.set(6 + i, accel + k, fine_tilt(i, k));
    estimate.state.x[static_cast<std::size_t>(accel + i)] += fine.bias()(TiltFilter::kAccel + i);
  }
  alignment.hold_since_ns = estimate.now_ns;
}

}  // namespace fathom::estimation

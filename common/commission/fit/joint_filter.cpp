#include "commission/fit/joint_filter.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using I = JointIndex;

constexpr double kLongestStep_s = 0.2;  // of the covariance
constexpr double kLostTurn_rad = 0.1;
constexpr double kLostSpeed_m_s = 2.0;
constexpr double kGate = 12.0;  // normalised square of an innovation from which on it counts less

// The lower triangle, row by row.
constexpr std::array<std::pair<int, int>, 6> kLower{{{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}}};

}  // namespace

JointFilter::JointFilter(const JointState& start, const Vector& sigma, const Noise& noise,
                         double latitude_rad)
    : state_(start),
      P_(sigma.cwiseAbs2().asDiagonal()),
      noise_(noise),
      earth_rate_N_(geo::earth_rate_N(latitude_rad)),
      gravity_N_(0.0, 0.0, geo::gravity(latitude_rad, 0.0)) {}

Vector3d JointFilter::right_rate(const Vector3d& rate) const {
  return (Matrix3d::Identity() + state_.gyro.matrix) * (rate - state_.gyro.bias);
}

Vector3d JointFilter::right_force(const Vector3d& force) const {
  return (Matrix3d::Identity() + state_.force.matrix) * (force - state_.force.bias);
}

void JointFilter::propagate(const Vector3d& rate, const Vector3d& force, double dt_s) {
  const Vector3d w = right_rate(rate);
  const Vector3d f = right_force(force);
  const Matrix3d C_middle = state_.C_NB * geo::to_matrix(geo::exp(0.5 * dt_s * w));
  const Vector3d felt = C_middle * f * dt_s;
  last_acceleration_N_ = felt / dt_s + gravity_N_ - 2.0 * earth_rate_N_.cross(state_.v_N);
  last_rate_B_ = w;
  state_.v_N += last_acceleration_N_ * dt_s;
  state_.C_NB =
      geo::to_matrix(geo::exp(-dt_s * earth_rate_N_)) * state_.C_NB * geo::to_matrix(geo::exp(dt_s * w));
  span_s_ += dt_s;
  felt_ += felt;
  turned_ += C_middle * dt_s;
  const Vector3d unbiased_rate = rate - state_.gyro.bias;
  const Vector3d unbiased_force = force - state_.force.bias;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      by_gyro_.col(3 * row + column) += dt_s * unbiased_rate[column] * C_middle.col(row);
  for (std::size_t k = 0; k < kLower.size(); ++k)
    by_force_.col(static_cast<Eigen::Index>(k)) +=
        dt_s * unbiased_force[kLower[k].second] * C_middle.col(kLower[k].first);
  if (span_s_ > kLongestStep_s) flush();
}

void JointFilter::flush() {
  if (span_s_ <= 0.0) return;
  // Rows of the transition that differ from the identity: those of attitude and velocity.
  Eigen::Matrix<double, I::kMoving, I::kCount> moved = Eigen::Matrix<double, I::kMoving, I::kCount>::Zero();
  moved.leftCols<I::kMoving>().setIdentity();
  moved.block<3, 3>(I::kAttitude, I::kGyroBias) = -turned_;
  moved.block<3, 9>(I::kAttitude, I::kGyroMatrix) = by_gyro_;
  const Matrix3d lever = -geo::skew(felt_);
  moved.block<3, 3>(I::kVelocity, I::kAttitude) = lever;
  moved.block<3, 3>(I::kVelocity, I::kGyroBias) = -0.5 * lever * turned_;
  moved.block<3, 9>(I::kVelocity, I::kGyroMatrix) = 0.5 * lever * by_gyro_;
  moved.block<3, 3>(I::kVelocity, I::kForceBias) = -turned_;
  moved.block<3, 6>(I::kVelocity, I::kForceMatrix) = by_force_;
  const Eigen::Matrix<double, I::kMoving, I::kCount> rows = moved * P_;
  const Eigen::Matrix<double, I::kMoving, I::kMoving> corner = rows * moved.transpose();
  P_.topRows<I::kMoving>() = rows;
  P_.leftCols<I::kMoving>() = rows.transpose();
  P_.topLeftCorner<I::kMoving, I::kMoving>() = corner;
  const double T = span_s_;
  P_.diagonal().segment<3>(I::kAttitude).array() += noise_.rate * noise_.rate * T;
  P_.diagonal().segment<3>(I::kVelocity).array() += noise_.force * noise_.force * T;
  P_.diagonal().segment<3>(I::kGyroBias).array() += noise_.rate_bias * noise_.rate_bias * T;
  P_.diagonal().segment<3>(I::kForceBias).array() += noise_.force_bias * noise_.force_bias * T;
  span_s_ = 0.0;
  felt_.setZero();
  turned_.setZero();
  by_gyro_.setZero();
  by_force_.setZero();
}

void JointFilter::lost() {
  flush();
  P_.diagonal().segment<3>(I::kAttitude).array() += kLostTurn_rad * kLostTurn_rad;
  P_.diagonal().segment<3>(I::kVelocity).array() += kLostSpeed_m_s * kLostSpeed_m_s;
}

JointFilter::Motion JointFilter::motion(double back_s, const Vector3d& smooth_rate, const Vector3d& turn,
                                        const Vector3d& smooth_force) const {
  Motion out;
  out.C_NB = state_.C_NB * geo::to_matrix(geo::exp(-back_s * last_rate_B_));
  out.v_N = state_.v_N - back_s * last_acceleration_N_;
  out.rate_B = right_rate(smooth_rate);
  out.turn_B = turn;
  out.acceleration_N = out.C_NB * right_force(smooth_force) + gravity_N_;
  return out;
}

Vector3d JointFilter::update_gps(const Vector3d& velocity_N, const Motion& motion, double latency_s,
                                 const Vector3d& sigma) {
  flush();
  const Vector3d& lever = state_.gps_lever_B_m;
  const Vector3d of_lever = motion.C_NB * motion.rate_B.cross(lever);
  const Vector3d changes =
      motion.acceleration_N +
      motion.C_NB * (motion.turn_B.cross(lever) + motion.rate_B.cross(motion.rate_B.cross(lever)));
  Rows H = Rows::Zero();
  H.block<3, 3>(0, I::kAttitude) = -geo::skew(of_lever);
  H.block<3, 3>(0, I::kVelocity).setIdentity();
  H.block<3, 3>(0, I::kGpsLever) = motion.C_NB * geo::skew(motion.rate_B);
  H.col(I::kGpsLatency) = -changes;
  // The motion was taken at an assumed latency.
  const Vector3d expected = motion.v_N + of_lever - changes * (state_.gps_latency_s - latency_s);
  return update(velocity_N - expected, H, sigma);
}

Vector3d JointFilter::update_dvl(const Vector3d& velocity_D, const Motion& motion, double latency_s,
                                 const Matrix3d& mirror, const Vector3d& sigma) {
  flush();
  const Vector3d& lever = state_.dvl_lever_B_m;
  const Vector3d v_B = motion.C_NB.transpose() * motion.v_N;
  const Vector3d there_B = v_B + motion.rate_B.cross(lever);
  const Vector3d changes_B =
      motion.C_NB.transpose() * motion.acceleration_N - motion.rate_B.cross(v_B) + motion.turn_B.cross(lever);
  const Matrix3d A = mirror * state_.C_BD.transpose() / state_.dvl_scale;
  const Vector3d reads = A * there_B;
  Rows H = Rows::Zero();
  H.block<3, 3>(0, I::kAttitude) = A * motion.C_NB.transpose() * geo::skew(motion.v_N);
  H.block<3, 3>(0, I::kVelocity) = A * motion.C_NB.transpose();
  H.block<3, 3>(0, I::kDvlTurn) = mirror * geo::skew(state_.C_BD.transpose() * there_B) / state_.dvl_scale;
  H.col(I::kDvlScale) = -reads;
  H.block<3, 3>(0, I::kDvlLever) = A * geo::skew(motion.rate_B);
  H.col(I::kDvlLatency) = -A * changes_B;
  const Vector3d expected = reads - A * changes_B * (state_.dvl_latency_s - latency_s);
  return update(velocity_D - expected, H, sigma);
}

Vector3d JointFilter::update(const Vector3d& residual, const Rows& H, const Vector3d& sigma) {
  // The products are small: Eigen's way with large matrices would take longer.
  const Eigen::Matrix<double, I::kCount, 3> PHt = P_.lazyProduct(H.transpose());
  const Matrix3d predicted = H * PHt;
  Matrix3d S = predicted;
  S.diagonal() += sigma.cwiseAbs2();
  Vector3d normalised = residual.cwiseQuotient(S.diagonal().cwiseSqrt());
  const double square = residual.dot(S.ldlt().solve(residual));
  if (square > kGate) {
    S = predicted;
    S.diagonal() += square / kGate * sigma.cwiseAbs2();
  }
  const Eigen::Matrix<double, I::kCount, 3> K = S.ldlt().solve(PHt.transpose()).transpose();
  P_ -= K.lazyProduct(PHt.transpose());
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  correct(K * residual);
  return normalised;
}

void JointFilter::correct(const Vector& step) {
  state_.C_NB = geo::to_matrix(geo::exp(step.segment<3>(I::kAttitude))) * state_.C_NB;
  state_.v_N += step.segment<3>(I::kVelocity);
  state_.gyro.bias += step.segment<3>(I::kGyroBias);
  state_.force.bias += step.segment<3>(I::kForceBias);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      state_.gyro.matrix(row, column) += step[I::kGyroMatrix + 3 * row + column];
  for (std::size_t k = 0; k < kLower.size(); ++k)
    state_.force.matrix(kLower[k].first, kLower[k].second) += step[I::kForceMatrix + static_cast<int>(k)];
  state_.gps_lever_B_m += step.segment<3>(I::kGpsLever);
  state_.gps_latency_s += step[I::kGpsLatency];
  state_.C_BD = state_.C_BD * geo::to_matrix(geo::exp(step.segment<3>(I::kDvlTurn)));
  state_.dvl_scale *= std::exp(step[I::kDvlScale]);
  state_.dvl_lever_B_m += step.segment<3>(I::kDvlLever);
  state_.dvl_latency_s += step[I::kDvlLatency];
}

}  // namespace fathom::commission

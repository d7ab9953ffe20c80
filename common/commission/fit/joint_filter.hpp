#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "commission/fit/dvl_fit.hpp"
#include "commission/fit/strapdown.hpp"

namespace fathom::commission {

/// Errors of the inertial unit that the whole log has in common, in the axes of the reading:
/// right = (I + matrix) (read - bias).
struct TriadErrors {
  Eigen::Vector3d bias = Eigen::Vector3d::Zero();
  Eigen::Matrix3d matrix =
      Eigen::Matrix3d::Zero();  ///< of the accelerometer lower triangular: it defines the axes
};

/// Everything that is estimated, at one instant.
struct JointState {
  Eigen::Matrix3d C_NB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d v_N = Eigen::Vector3d::Zero();
  TriadErrors gyro, force;
  Eigen::Vector3d gps_lever_B_m = Eigen::Vector3d::Zero();
  double gps_latency_s = 0.0;
  Eigen::Matrix3d C_BD = Eigen::Matrix3d::Identity();
  double dvl_scale = 1.0;
  Eigen::Vector3d dvl_lever_B_m = Eigen::Vector3d::Zero();
  double dvl_latency_s = 0.0;
};

/// Where the unknowns stand in the error state.
struct JointIndex {
  static constexpr int kAttitude = 0, kVelocity = 3, kMoving = 6;
  static constexpr int kGyroBias = 6, kForceBias = 9, kGyroMatrix = 12, kForceMatrix = 21;
  static constexpr int kGpsLever = 27, kGpsLatency = 30;
  static constexpr int kDvlTurn = 31, kDvlScale = 34, kDvlLever = 35, kDvlLatency = 38, kCount = 39;
};

/// What is between two updates: one sample of the inertial unit after the other.
class JointFilter {
 public:
  using Vector = Eigen::Matrix<double, JointIndex::kCount, 1>;
  using Matrix = Eigen::Matrix<double, JointIndex::kCount, JointIndex::kCount>;
  struct Noise {
    double rate = 0.0;        ///< rad/sqrt(s)
    double force = 0.0;       ///< (m/s)/sqrt(s)
    double rate_bias = 0.0;   ///< random walk, (rad/s)/sqrt(s)
    double force_bias = 0.0;  ///< random walk, (m/s^2)/sqrt(s)
  };
  JointFilter(const JointState& start, const Vector& sigma, const Noise& noise, double latitude_rad);

  /// One sample, of the interval of `dt_s` before it; rate and force in the axes of the reading.
  void propagate(const Eigen::Vector3d& rate, const Eigen::Vector3d& force, double dt_s);
  /// The inertial unit was silent: the vehicle may have done anything.
  void lost();

  /// The motion about the instant `back_s` before the last sample: what an instrument there measures.
  struct Motion {
    Eigen::Matrix3d C_NB;
    Eigen::Vector3d v_N;
    Eigen::Vector3d rate_B;          ///< smoothed
    Eigen::Vector3d turn_B;          ///< its derivative
    Eigen::Vector3d acceleration_N;  ///< smoothed
  };
  [[nodiscard]] Motion motion(double back_s, const Eigen::Vector3d& smooth_rate, const Eigen::Vector3d& turn,
                              const Eigen::Vector3d& smooth_force) const;

  /// Three readings, with noise of `sigma` each. Returns the innovations over their expected sigma.
  Eigen::Vector3d update_gps(const Eigen::Vector3d& velocity_N, const Motion& motion, double latency_s,
                             const Eigen::Vector3d& sigma);
  Eigen::Vector3d update_dvl(const Eigen::Vector3d& velocity_D, const Motion& motion, double latency_s,
                             const Eigen::Matrix3d& mirror, const Eigen::Vector3d& sigma);

  [[nodiscard]] const JointState& state() const { return state_; }
  [[nodiscard]] Vector sigmas() const { return P_.diagonal().cwiseMax(0.0).cwiseSqrt(); }
  /// Right rate and force of a sample.
  [[nodiscard]] Eigen::Vector3d right_rate(const Eigen::Vector3d& rate) const;
  [[nodiscard]] Eigen::Vector3d right_force(const Eigen::Vector3d& force) const;

 private:
  using Rows = Eigen::Matrix<double, 3, JointIndex::kCount>;
  void flush();
  Eigen::Vector3d update(const Eigen::Vector3d& residual, const Rows& H, const Eigen::Vector3d& sigma);
  void correct(const Vector& step);

  JointState state_;
  Matrix P_;
  Noise noise_;
  Eigen::Vector3d earth_rate_N_;
  Eigen::Vector3d gravity_N_;
  Eigen::Vector3d last_acceleration_N_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_rate_B_ = Eigen::Vector3d::Zero();
  // Since the covariance was last moved on.
  double span_s_ = 0.0;
  Eigen::Vector3d felt_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d turned_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 9> by_gyro_ = Eigen::Matrix<double, 3, 9>::Zero();
  Eigen::Matrix<double, 3, 6> by_force_ = Eigen::Matrix<double, 3, 6>::Zero();
};

}  // namespace fathom::commission

#pragma once

#include <Eigen/Core>

#include "geo/so3.hpp"

namespace fathom::estimation {

/// Attitude and velocity through the water of a vehicle under way, by an invariant extended Kalman filter
/// (TILT-1 to TILT-4). Truth is `C = Gamma(phi) C^`, `v = Gamma(phi) (v^ + dv)`, all other states truth minus
/// estimate. With these errors the body velocity C'v does not depend on phi, so that a large initial tilt
/// does not spoil the linearisation. A value of fixed size.
class TiltFilter {
 public:
  enum Index : int {
    kPhi = 0,         ///< attitude, along N, rad
    kVelocity = 3,    ///< along N, m/s
    kDepth = 6,       ///< m, down
    kAccel = 7,       ///< accelerometer bias along B, m/s^2
    kScale = 10,      ///< of the speed log
    kLogBias = 11,    ///< of the speed log, m/s
    kSideBias = 12,   ///< of the modelled side slip, m/s
    kHeaveBias = 13,  ///< of the modelled heave velocity, m/s
    kSize = 14
  };
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// One scalar measurement: innovation measured - predicted = h x + noise.
  struct Row {
    Vector h = Vector::Zero();
    double innovation = 0.0;
    double variance = 1.0;
  };
  /// What an update did.
  struct Result {
    Eigen::Vector3d rotation_N_rad = Eigen::Vector3d::Zero();  ///< by which the attitude was turned
    Vector x = Vector::Zero();                                 ///< estimated error
    double squared_distance = 0.0;                             ///< of the rows taken
    int taken = 0;
    int refused = 0;  ///< rows further from possible than the limit
  };

  void start(const geo::Quaternion& q_NB, const Eigen::Vector3d& v_N_m_s, double depth_m,
             const Matrix& covariance);

  /// One inertial interval: mean rate of B against N and specific force along B, gravity (and what else
  /// pulls) along N. `noise` is added to the diagonal, `keep` is the share of each bias that survives the
  /// step.
  void predict(double dt_s, const Eigen::Vector3d& rate_NB_B_rad_s, const Eigen::Vector3d& force_B_m_s2,
               const Eigen::Vector3d& g_N_m_s2, const Vector& noise, const Vector& keep);

  /// The rows of the measurements, ready for update().
  [[nodiscard]] Row speed_row(double speed_m_s, double sigma_m_s) const;
  [[nodiscard]] Row side_row(double side_m_s, double sigma_m_s) const;
  [[nodiscard]] Row heave_row(double heave_m_s, double sigma_m_s) const;
  [[nodiscard]] Row depth_row(double depth_m, double sigma_m) const;
  /// Takes rows of one instant, all linearised there. A row beyond `limit_sigma` is refused.
  Result update(const Row* rows, int count, double limit_sigma);

  /// After an interval without measurements: more doubt along each axis, rad, m/s, and of the depth, m.
  void widen(double angle_sigma_rad, double velocity_sigma_m_s, double depth_sigma_m);

  /// Turns everything that is along N about the vertical. The errors of this filter do not care.
  void turn_heading(double angle_rad);

  [[nodiscard]] const geo::Quaternion& q_NB() const { return q_NB_; }
  [[nodiscard]] const Eigen::Vector3d& v_N_m_s() const { return v_N_; }
  /// Along B x.
  [[nodiscard]] double forward_m_s() const { return geo::to_matrix(q_NB_).col(0).dot(v_N_); }
  [[nodiscard]] double depth_m() const { return depth_m_; }
  [[nodiscard]] const Vector& bias() const { return bias_; }  ///< the first seven are 0
  [[nodiscard]] const Matrix& covariance() const { return p_; }

  /// For archives: see fields/alignment.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  geo::Quaternion q_NB_;
  Eigen::Vector3d v_N_ = Eigen::Vector3d::Zero();
  double depth_m_ = 0.0;
  Vector bias_ = Vector::Zero();
  Matrix p_ = Matrix::Zero();
};

}  // namespace fathom::estimation

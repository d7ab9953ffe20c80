#pragma once

#include <Eigen/Core>

namespace fathom::estimation {

/// Squares of what scale errors, misalignments and the like act on (NOISE-1).
struct SquaredInputs {
  Eigen::Vector3d rate_B = Eigen::Vector3d::Zero();   ///< (rad/s)^2
  Eigen::Vector3d force_B = Eigen::Vector3d::Zero();  ///< but for gravity, (m/s^2)^2
  double felt = 0.0;                                  ///< of the force that is not felt at rest and level

  SquaredInputs() = default;
  SquaredInputs(const Eigen::Matrix3d& C_NB, const Eigen::Vector3d& rate_B_rad_s,
                const Eigen::Vector3d& force_B_m_s2);
};

/// Some inertial steps in a row that the state has made and the covariance has not (KF-1): what its one long
/// step over them needs, as integrals over the time.
class Stride {
 public:
  /// One more step: attitude, rate and force at its begin, corrected.
  void add(double dt_s, const Eigen::Matrix3d& C_NB, const Eigen::Vector3d& rate_B_rad_s,
           const Eigen::Vector3d& force_B_m_s2);
  /// Whether the covariance has to follow now; it may wait `longest_s`.
  [[nodiscard]] bool is_due(double longest_s) const;

  [[nodiscard]] bool is_empty() const { return !(dt_s_ > 0.0); }
  [[nodiscard]] double dt_s() const { return dt_s_; }
  // Means; of a stride that is not empty.
  [[nodiscard]] Eigen::Matrix3d C_NB() const { return C_NB_s_ / dt_s_; }
  [[nodiscard]] Eigen::Vector3d rate_B_rad_s() const { return turn_B_rad_ / dt_s_; }
  [[nodiscard]] Eigen::Vector3d force_B_m_s2() const { return dv_B_m_s_ / dt_s_; }
  [[nodiscard]] Eigen::Vector3d force_N_m_s2() const { return dv_N_m_s_ / dt_s_; }
  [[nodiscard]] SquaredInputs squares() const;

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  double dt_s_ = 0.0;
  Eigen::Matrix3d C_NB_s_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d turn_B_rad_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv_B_m_s_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d dv_N_m_s_ = Eigen::Vector3d::Zero();
  SquaredInputs squares_s_;
};

}  // namespace fathom::estimation

#pragma once

#include "study/consistency/ecef.hpp"
#include "study/consistency/manoeuvres.hpp"

namespace fathom::study {

/// Where a vehicle is at an instant.
struct Pose {
  ecef::Geodetic place;
  Eigen::Vector3d velocity_N_m_s = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_NB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d rate_EB_B_rad_s = Eigen::Vector3d::Zero();  ///< relative to the Earth
};

/// What a perfect inertial unit integrates over an interval, along B.
struct PerfectIncrements {
  Eigen::Vector3d angle_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
};

/// Carries manoeuvres out on the Earth. The position is integrated in Earth-fixed axes (Runge-Kutta of fourth
/// order), acceleration and turn rate are central differences of velocity and attitude there, and specific
/// force is acceleration against the stars less gravitation.
class TruthPath {
 public:
  TruthPath(const Manoeuvres& manoeuvres, const ecef::Geodetic& start);

  /// Increments by Simpson's rule.
  PerfectIncrements advance(double dt_s);
  [[nodiscard]] double time_s() const { return t_s_; }
  [[nodiscard]] Pose pose() const;

 private:
  struct Felt {
    Eigen::Vector3d rate_EB_B_rad_s;
    Eigen::Vector3d rate_IB_B_rad_s;
    Eigen::Vector3d force_B_m_s2;
  };
  /// Attitude and velocity along E.
  struct Moving {
    Eigen::Matrix3d axes_EB;
    Eigen::Vector3d velocity_E_m_s;
  };
  [[nodiscard]] Moving moving(double t_s, const Eigen::Vector3d& r_E_m) const;
  [[nodiscard]] Felt felt(double t_s, const Eigen::Vector3d& r_E_m) const;

  const Manoeuvres* manoeuvres_;
  double t_s_ = 0.0;
  Eigen::Vector3d r_E_m_;
  Felt now_;
};

}  // namespace fathom::study

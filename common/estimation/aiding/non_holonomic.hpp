#pragma once

#include <algorithm>
#include <cmath>

#include "estimation/aiding/model.hpp"
#include "estimation/engine_config.hpp"

namespace fathom::estimation {

/// A vehicle on wheels, or on runners, moves along its own forward axis only: velocity sideways and upwards
/// at a point of it is zero (AID-NHC-1..2). The wheels' axes W are the configured ones turned by the mount
/// angles, the point is the configured one moved by the mount lever; both are states where they are
/// estimated.
class NonHolonomic {
 public:
  static constexpr const char* kName = "non_holonomic";
  using Vector2 = Eigen::Vector2d;

  NonHolonomic(const AidingState& s, const NonHolonomicConfig& config)
      : s_(s),
        config_(config),
        C_WB_(geo::to_matrix(geo::from_rpy(geo::vec(config.mounting_rpy_rad))).transpose()),
        lever_B_m_(geo::vec(config.lever_B_m) + s.value3(Group::mount_lever)),
        v_B_(s.C_NB.transpose() * s.state.nav.v_N_m_s + geo::cross(s.rate_nb_B_rad_s, lever_B_m_)),
        turn_(Matrix3::Identity() -
              geo::skew(Vector3(0.0, s.value(Group::mount_angles, 0), s.value(Group::mount_angles, 1)))) {}

  [[nodiscard]] int dimension() const { return 2; }
  [[nodiscard]] Vector2 measured() const { return Vector2::Zero(); }
  [[nodiscard]] Vector2 predicted() const { return (turn_ * C_WB_ * v_B_).tail<2>(); }  // (AID-NHC-1)
  void jacobian(Jacobian& h) const {
    // (AID-NHC-2)
    const Eigen::Matrix<double, 2, 3> d = (turn_ * C_WB_).bottomRows<2>();
    const Eigen::Matrix<double, 2, 3> to_W = d * s_.C_NB.transpose();
    h.block(Group::velocity, to_W);
    h.block(Group::attitude, -to_W * geo::skew(s_.state.nav.v_N_m_s));
    h.block(Group::gyro_bias, -d * geo::skew(lever_B_m_));
    h.block(Group::mount_angles, -geo::skew(C_WB_ * v_B_).bottomRightCorner<2, 2>());
    h.block(Group::mount_lever, -d * geo::skew(s_.rate_nb_B_rad_s));
  }
  [[nodiscard]] Vector2 noise() const {
    // (AID-NHC-3)
    const double lasting = std::sqrt(std::max(1.0, config_.slip_time_s * config_.rate_hz));
    return lasting * Vector2(config_.lateral_sigma_m_s, config_.vertical_sigma_m_s);
  }

 private:
  const AidingState& s_;
  const NonHolonomicConfig& config_;
  Matrix3 C_WB_;
  Vector3 lever_B_m_;
  Vector3 v_B_;
  Matrix3 turn_;
};

}  // namespace fathom::estimation

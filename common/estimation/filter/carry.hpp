#pragma once

#include <array>

#include <Eigen/Core>

#include "estimation/filter/state_index.hpp"

namespace fathom::estimation {

class ErrorFilter;

/// The errors of velocity, attitude and accelerometer bias written anew about a corrected estimate (KF-5):
///   velocity' = turn velocity + velocity_by_attitude attitude,
///   attitude' = turn attitude,  bias' = bias_own bias.
struct Carry {
  static constexpr int kFirst = 3;  ///< of the nine states
  static constexpr int kStates = 9;

  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< about down
  Eigen::Matrix3d velocity_by_attitude = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d bias_own = Eigen::Matrix3d::Identity();

  [[nodiscard]] Eigen::Matrix<double, kStates, kStates> matrix() const;
};

/// Of a correction by the estimated error `x`, with the covariance behind it; `C_NB` is the corrected
/// attitude. `before` and `after`: the velocity that is measured along the vehicle.
[[nodiscard]] Carry carried(const ErrorFilter& filter, const std::array<double, kMaxStates>& x,
                            const Eigen::Matrix3d& C_NB, const Eigen::Vector3d& before_N_m_s,
                            const Eigen::Vector3d& after_N_m_s);

}  // namespace fathom::estimation

#pragma once

#include <array>
#include <string>

#include <Eigen/Core>

namespace fathom::commission {

/// The 48 ways in which three axes can be exchanged and reversed, the identity first. Rows say where a right
/// axis comes from: right = P * recorded.
[[nodiscard]] const std::array<Eigen::Matrix3d, 48>& signed_axes();

/// The one of them that is nearest to a matrix, its scale left aside.
[[nodiscard]] const Eigen::Matrix3d& nearest_signed_axes(const Eigen::Matrix3d& matrix);

/// What is the matter where right = P * recorded: "all axes are negated", "x and y are exchanged",
/// "the axes are turned by roll 180, pitch 0, yaw 0 deg". Empty for the identity.
[[nodiscard]] std::string describe(const Eigen::Matrix3d& P);

/// The rotation of positive determinant that fits sum |y - R x|^2 best, from sum y x^T.
[[nodiscard]] Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& sum_y_xT);

}  // namespace fathom::commission

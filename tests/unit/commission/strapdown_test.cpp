// What a small bias does to the integration is what its integrals say.
#include "commission/fit/strapdown.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace fathom::commission {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Half a minute of turning and shaking, with a gyro that was mounted otherwise.
ImuSeries shaken() {
  ImuSeries out;
  for (int k = 0; k <= 3000; ++k) {
    const double t = 0.01 * k;
    out.t_s.push_back(t);
    out.rate.emplace_back(0.3 * std::sin(t), 0.2 * std::cos(0.7 * t), 0.4);
    out.force.emplace_back(std::sin(2.0 * t), 0.5, -9.8 + std::cos(t));
  }
  return out;
}

TEST(Strapdown, ItsIntegralsTellWhatABiasDoes) {
  const ImuSeries imu = shaken();
  ImuReading reading;
  reading.rate << 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.02;
  const Strapdown strapdown(imu, reading, 0.0, 30.0, Strapdown::Integrate::motion_and_biases);
  const Strapdown::State state = strapdown.at(24.37);
  const Strapdown::OfBias of_bias = strapdown.of_bias_at(24.37);
  constexpr double kStep = 1e-6;
  Matrix3d of_velocity;
  Matrix3d of_angle;
  for (int axis = 0; axis < 3; ++axis) {
    ImuReading other = reading;
    other.rate_bias[axis] += kStep;
    const Strapdown::State biased = Strapdown(imu, other, 0.0, 30.0).at(24.37);
    of_velocity.col(axis) = (biased.S - state.S) / kStep;
    const Matrix3d turn = (biased.C_WB * state.C_WB.transpose() - Matrix3d::Identity()) / kStep;
    of_angle.col(axis) = Vector3d(turn(2, 1), turn(0, 2), turn(1, 0));
  }
  const Matrix3d velocity = of_bias.IFC * reading.rate;
  const Matrix3d angle = -of_bias.IC * reading.rate;
  EXPECT_LT((of_velocity - velocity).norm(), 1e-3 * velocity.norm());
  EXPECT_LT((of_angle - angle).norm(), 1e-3 * angle.norm());
}

}  // namespace
}  // namespace fathom::commission

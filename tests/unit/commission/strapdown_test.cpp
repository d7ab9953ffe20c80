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
  const Strapdown::OfBias of_bias = strapdown.both_at(24.37).of_bias;
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

TEST(Strapdown, ABiasThatMovesIsTakenIn) {
  const ImuSeries imu = shaken();
  ImuReading reading;
  reading.rate << 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.02;
  MovedStrapdown moved(imu, reading, 0.0, 30.0);
  const auto expect_as_integrated = [&](double rate_bias, double within) {
    SCOPED_TRACE(rate_bias);
    reading.rate_bias = Vector3d(rate_bias, -0.5 * rate_bias, rate_bias);
    moved.move_to(reading.rate_bias);
    const Strapdown::Both there = moved.at(24.37);
    const Strapdown::Both expected =
        Strapdown(imu, reading, 0.0, 30.0, Strapdown::Integrate::motion_and_biases).both_at(24.37);
    EXPECT_LE((there.state.S - expected.state.S).norm(), 250.0 * within);  // m/s, of gravity felt as long
    EXPECT_LE((there.state.C_WB - expected.state.C_WB).norm(), within);
    EXPECT_LE((there.state.rate - expected.state.rate).norm(), 1e-12);
  };
  expect_as_integrated(2e-5, 1e-6);  // little: by its derivatives
  expect_as_integrated(4e-2, 0.0);   // far: anew
  expect_as_integrated(4e-2 - 2e-5, 1e-6);
  expect_as_integrated(0.0, 0.0);
}

}  // namespace
}  // namespace fathom::commission

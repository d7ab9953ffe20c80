// The way back over a filter along one axis: the numerical vectors, and a drift that is found late.
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimation/smoothing/filter_log.hpp"
#include "support/vectors.hpp"

namespace fathom::estimation {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using nlohmann::json;
using test::matrix;
using test::relative_error;

constexpr double kTolerance = 1e-9;

/// Position and velocity along one axis in the filter's own states: r' = v, nothing else.
struct OneAxis {
  static constexpr int kPosition = 0;
  static constexpr int kVelocity = 3;
  ProcessNoise noise;
  [[nodiscard]] static NavTransition step(double dt_s) {
    const Eigen::Matrix3d none = Eigen::Matrix3d::Zero();
    const ErrorRates still{none, none, none, none, none, Vector3d::Zero(), Vector3d::Zero()};
    return {StateIndex(StateGroups{}), still, none, Vector3d::Zero(), Vector3d::Zero(), dt_s};
  }
};

Eigen::Matrix2d pair_of(const ErrorFilter& filter) {
  Eigen::Matrix2d p;
  p << filter(0, 0), filter(0, 3), filter(3, 0), filter(3, 3);
  return p;
}

class SmoothingVectors : public test::VectorsTest {};

TEST_F(SmoothingVectors, RtsStep) {
  const json& j = in("rts_step");
  const json& e = out("rts_step");
  const OneAxis axis;
  ErrorFilter before(15);
  const MatrixXd p_plus = matrix(j.at("P_plus_k"));
  before.set(0, 0, p_plus(0, 0));
  before.set(0, 3, p_plus(0, 1));
  before.set(3, 3, p_plus(1, 1));
  FilterLog log(15);
  ErrorFilter after = before;
  after.record_to(&log);
  after.propagate(OneAxis::step(1.0), axis.noise);
  const MatrixXd q = matrix(j.at("Q"));
  after.widen(0, q(0, 0));
  after.widen(3, q(1, 1));

  // What the future says, from the smoothed state and covariance behind the step.
  const Vector2d x_plus(j.at("x_plus_k").at(0).get<double>(), j.at("x_plus_k").at(1).get<double>());
  const Vector2d x_later(j.at("x_s_k1").at(0).get<double>(), j.at("x_s_k1").at(1).get<double>());
  const Vector2d x_predicted(x_plus(0) + x_plus(1), x_plus(1));
  const Eigen::Matrix2d p_minus_inverse = pair_of(after).inverse();
  const Eigen::Matrix2d p_later = matrix(j.at("P_s_k1"));
  const auto adjoint = [&](const Vector2d& lambda2, const Eigen::Matrix2d& curvature2) {
    Adjoint::Vector lambda = Adjoint::Vector::Zero(15);
    Adjoint::Matrix curvature = Adjoint::Matrix::Zero(15, 15);
    const std::array<int, 2> at{0, 3};
    for (int r = 0; r < 2; ++r) {
      lambda(at[static_cast<std::size_t>(r)]) = lambda2(r);
      for (int c = 0; c < 2; ++c)
        curvature(at[static_cast<std::size_t>(r)], at[static_cast<std::size_t>(c)]) = curvature2(r, c);
    }
    return Adjoint(lambda, curvature);
  };
  Adjoint way_back = adjoint(p_minus_inverse * (x_predicted - x_later),
                             p_minus_inverse * (pair_of(after) - p_later) * p_minus_inverse);
  log.back_through(log.size(), 0, way_back);
  std::array<double, kMaxStates> x{};
  way_back.smoothed_error(before, x);
  ErrorFilter smoothed = before;
  const std::array<int, 2> states{0, 3};
  way_back.smooth_covariance(states, smoothed);
  EXPECT_LT(relative_error(x_plus(0) + x[0], e.at("x_s_k").at(0).get<double>()), kTolerance);
  EXPECT_LT(relative_error(x_plus(1) + x[3], e.at("x_s_k").at(1).get<double>()), kTolerance);
  EXPECT_LT(relative_error(pair_of(smoothed), matrix(e.at("P_s_k"))), kTolerance);

  // The gain: what a later correction of one state moves here.
  Eigen::Matrix2d gain;
  for (int column = 0; column < 2; ++column) {
    Adjoint unit = adjoint(-p_minus_inverse.col(column), Eigen::Matrix2d::Zero());
    log.back_through(log.size(), 0, unit);
    unit.smoothed_error(before, x);
    gain.col(column) << x[0], x[3];
  }
  EXPECT_LT(relative_error(gain, matrix(e.at("G"))), kTolerance);
}

TEST_F(SmoothingVectors, ClonedState) {
  // A state that keeps still is a clone. The vector's white acceleration: q dt = 0.02 on the velocity.
  const json& j = in("clone_delayed_update");
  const json& e = out("clone_delayed_update");
  constexpr int kClone = 9;
  OneAxis axis;
  axis.noise.velocity(0, 0) = 0.01;
  const MatrixXd p0 = matrix(j.at("P0"));
  ErrorFilter filter(15);
  filter.set(0, 0, p0(0, 0));
  filter.set(0, 3, p0(0, 1));
  filter.set(3, 3, p0(1, 1));
  const ErrorFilter at_the_ping = filter;
  filter.set(kClone, 0, p0(0, 0));
  filter.set(kClone, 3, p0(0, 1));
  filter.set(kClone, kClone, p0(0, 0));
  filter.propagate(OneAxis::step(2.0), axis.noise);
  const std::array<int, 3> at{0, 3, kClone};
  const auto block = [&](const ErrorFilter& of, int size) {
    MatrixXd p(size, size);
    for (int r = 0; r < size; ++r)
      for (int c = 0; c < size; ++c)
        p(r, c) = of(at[static_cast<std::size_t>(r)], at[static_cast<std::size_t>(c)]);
    return p;
  };
  EXPECT_LT(relative_error(block(filter, 3), matrix(e.at("P_aug_minus"))), kTolerance);

  const auto measure = [&](ErrorFilter& of, std::size_t state, std::array<double, kMaxStates>& x) {
    Observation observation;
    observation.rows = 1;
    observation.innovation[0] = j.at("z_pred_minus_meas_at_ping").get<double>();
    observation.sigma[0] = std::sqrt(j.at("R").get<double>());
    observation.h[0][state] = 1.0;
    observation.list_columns(15);
    InnovationStatistics statistics;
    of.statistics(observation, 1.0, statistics);
    ASSERT_TRUE(of.update(observation, statistics, x));
  };
  std::array<double, kMaxStates> x{};
  measure(filter, kClone, x);
  for (std::size_t i = 0; i < 3; ++i) {
    const double dx = x[static_cast<std::size_t>(at[i])];
    EXPECT_LT(relative_error(dx, e.at("dx").at(i).get<double>()), kTolerance);
    EXPECT_LT(
        relative_error(dx / j.at("z_pred_minus_meas_at_ping").get<double>(), e.at("K").at(i).get<double>()),
        kTolerance);
  }
  EXPECT_LT(relative_error(block(filter, 2), matrix(e.at("P_plus"))), kTolerance);

  // Going back to the ping, measuring and coming forward again, as the engine does, is the same.
  ErrorFilter repeated = at_the_ping;
  std::array<double, kMaxStates> dx{};
  measure(repeated, 0, dx);
  repeated.propagate(OneAxis::step(2.0), axis.noise);
  EXPECT_LT(relative_error(block(repeated, 2), matrix(e.at("P_plus"))), kTolerance);
  EXPECT_LT(relative_error(dx[0] + 2.0 * dx[3], x[0]), kTolerance);
  EXPECT_LT(relative_error(dx[3], x[3]), kTolerance);
}

// A drift that P did not know, found by a fix behind the room that was made for it (SMOOTH-5).
TEST(SmoothingDrift, WhatIsFoundBehindTheRoomHoldsBeforeIt) {
  const OneAxis axis;
  ErrorFilter filter(15);
  filter.set(0, 0, 1.0);
  filter.set(3, 3, 0.01);
  FilterLog log(15);
  filter.record_to(&log);
  const ErrorFilter start = filter;
  for (int k = 0; k < 10; ++k) filter.propagate(OneAxis::step(1.0), axis.noise);
  const ErrorFilter before = filter;
  const std::size_t drifted = log.size();
  std::array<double, kNavStates> room{};
  room[0] = 1e4;
  filter.widen_drifted(room);
  EXPECT_EQ(filter(0, 0), before(0, 0) + 1e4);

  constexpr double kDrift_m = 100.0;  // a sigma there is 1.4 m
  constexpr double kNoise_m = 0.5;
  Observation observation;
  observation.rows = 1;
  observation.innovation[0] = kDrift_m;
  observation.sigma[0] = kNoise_m;
  observation.h[0][0] = 1.0;
  observation.list_columns(15);
  InnovationStatistics statistics;
  filter.statistics(observation, 1.0, statistics);
  std::array<double, kMaxStates> found{};
  ASSERT_TRUE(filter.update(observation, statistics, found));
  EXPECT_NEAR(found[0], kDrift_m, 0.01);

  Adjoint adjoint(15);
  log.back_through(log.size(), drifted, adjoint);
  std::array<double, kMaxStates> x{};
  adjoint.smoothed_error(before, x);
  EXPECT_NEAR(x[0], found[0], 1e-9 * kDrift_m);
  EXPECT_NEAR(x[3], before(3, 0) / before(0, 0) * found[0], 1e-9 * kDrift_m);
  const std::array<int, 2> states{0, 3};
  ErrorFilter smoothed = before;
  adjoint.smooth_covariance(states, smoothed);
  EXPECT_NEAR(smoothed(0, 0), filter(0, 0), 1e-6 * filter(0, 0));
  EXPECT_LT(smoothed(3, 3), before(3, 3));

  // All the way back it is a velocity that was wrong all along.
  log.back_through(drifted, 0, adjoint);
  adjoint.smoothed_error(start, x);
  EXPECT_NEAR(x[0] + 10.0 * x[3], found[0], 1e-6 * kDrift_m);
  EXPECT_NEAR(x[3] / x[0], 10.0 * 0.01 / 1.0, 1e-6);

  // As noise it would have stayed where it was found.
  Adjoint noise(15);
  FilterLog other(15);
  ErrorFilter again = before;
  again.record_to(&other);
  again.widen(0, 1e4);
  ASSERT_TRUE(again.update(observation, statistics, found));
  other.back_through(other.size(), 0, noise);
  noise.smoothed_error(before, x);
  EXPECT_LT(std::abs(x[0]), 0.1 * kDrift_m);
}

}  // namespace
}  // namespace fathom::estimation

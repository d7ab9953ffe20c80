#include "estimation/alignment/moving_start.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "base/units.hpp"
#include "sim/random.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kG = 9.81;
constexpr double kLength_s = 2.0;
constexpr double kImu_hz = 200.0;
constexpr double kGps_hz = 5.0;
constexpr TimeNs kBegin = 1'700'000'000 * kNsPerSecond;

/// A motion over a flat Earth that does not turn: attitude and velocity at any instant.
struct Motion {
  std::function<Vector3d(double)> rpy_rad;
  std::function<Vector3d(double)> velocity_N_m_s;

  [[nodiscard]] geo::Quaternion q_NB(double t) const { return geo::from_rpy(rpy_rad(t)); }
  [[nodiscard]] Vector3d rate_B(double t, double h = 1e-4) const {
    return geo::log(geo::conjugate(q_NB(t - h)) * q_NB(t + h)) / (2.0 * h);
  }
  [[nodiscard]] Vector3d force_B(double t, double h = 1e-4) const {
    const Vector3d a = (velocity_N_m_s(t + h) - velocity_N_m_s(t - h)) / (2.0 * h);
    return geo::to_matrix(q_NB(t)).transpose() * (a - Vector3d(0.0, 0.0, kG));
  }
};

/// Level flight along the forward axis that turns at `rate_rad_s`, banked as a coordinated turn is.
Motion turn(double speed_m_s, double rate_rad_s, double heading_rad = 0.7) {
  const double bank = std::atan(speed_m_s * rate_rad_s / kG);
  return {[=](double t) { return Vector3d(bank, 0.05, heading_rad + rate_rad_s * t); },
          [=](double t) {
            const double course = heading_rad + rate_rad_s * t;
            return Vector3d(speed_m_s * std::cos(course), speed_m_s * std::sin(course), 0.0);
          }};
}

Motion straight() {
  return turn(30.0, 0.0);
}

/// Rolls from one bank into the other and climbs, ever faster.
Motion weaving() {
  return {[](double t) {
            return Vector3d(0.6 * std::sin(1.2 * t), 0.1 + 0.05 * std::sin(0.7 * t), 1.0 + 0.3 * t);
          },
          [](double t) {
            const double speed = 25.0 + 1.5 * t;
            return Vector3d(speed * std::cos(1.0 + 0.3 * t), speed * std::sin(1.0 + 0.3 * t), -2.0 - t);
          }};
}

struct Errors {
  Vector3d accel_bias_B_m_s2 = Vector3d::Zero();
  Vector3d gyro_bias_B_rad_s = Vector3d::Zero();
  double velocity_m_s = 0.0;
  Vector3d middle_m_s = Vector3d::Zero();  ///< added to what GPS says about half way
  Vector3d lever_B_m = Vector3d::Zero();
};

VelocityWindow measure(const Motion& motion, const Errors& errors, std::uint64_t seed = 1) {
  sim::Random random(seed, "gps");
  VelocityWindow window;
  const double dt = 1.0 / kImu_hz;
  const int every = static_cast<int>(kImu_hz / kGps_hz);
  for (int i = 0; i < 1000 && !window.complete(); ++i) {
    const double t = i * dt;
    const double middle = t + 0.5 * dt;
    if (i % every == 0) {
      const Matrix3d c = geo::to_matrix(motion.q_NB(t));
      Vector3d v = motion.velocity_N_m_s(t) + c * geo::cross(motion.rate_B(t), errors.lever_B_m);
      for (int k = 0; k < 3; ++k) v(k) += random.normal(errors.velocity_m_s);
      if (std::abs(t - 0.4 * kLength_s) < dt) v += errors.middle_m_s;
      window.measured(kBegin + from_seconds(t), v, Vector3d::Constant(errors.velocity_m_s));
    }
    window.add(kBegin + from_seconds(t + dt), dt, motion.rate_B(middle) + errors.gyro_bias_B_rad_s,
               motion.force_B(middle) + errors.accel_bias_B_m_s2, kLength_s);
  }
  return window;
}

/// The window ends one interval after its last velocity.
double end_s() {
  return kLength_s + 1.0 / kImu_hz;
}

MovingStartInputs inputs() {
  return {.gravity_N_m_s2 = Vector3d(0.0, 0.0, kG),
          .lever_B_m = Vector3d::Zero(),
          .heading_rad = std::nullopt,
          .heading_sigma_rad = 2.0 * kRadPerDeg,
          .force_sigma_m_s2 = 1e-3,
          .accel_bias_sigma_m_s2 = 0.05};
}

/// About N, as the filter counts it: truth = exp(error) * estimate.
Vector3d attitude_error(const Motion& motion, const MovingStart& start) {
  return geo::log(motion.q_NB(end_s()) * geo::conjugate(start.q_NB));
}

TEST(MovingStart, FindsTheAttitudeOfAnyMotionAlongTheForwardAxis) {
  for (const Motion& motion : {straight(), turn(30.0, 0.3), turn(15.0, -0.8), turn(60.0, 0.15, -2.9)}) {
    const auto start = start_moving(measure(motion, {}), inputs());
    ASSERT_TRUE(start);
    EXPECT_LT(attitude_error(motion, *start).norm(), 0.05 * kRadPerDeg);
    EXPECT_LT((start->v_N_m_s - motion.velocity_N_m_s(end_s())).norm(), 0.02);
  }
}

TEST(MovingStart, ACompassTellsWhatTheCourseCannot) {
  // The forward axis is up to 20 degrees off the course here, and rolls.
  const Motion motion = weaving();
  MovingStartInputs in = inputs();
  in.heading_rad = motion.rpy_rad(kLength_s).z();
  const auto start = start_moving(measure(motion, {}), in);
  ASSERT_TRUE(start);
  EXPECT_LT(attitude_error(motion, *start).norm(), 0.2 * kRadPerDeg);
}

TEST(MovingStart, ALeverArmIsTakenIntoAccount) {
  const Motion motion = weaving();
  Errors errors;
  errors.lever_B_m = Vector3d(1.5, -0.4, -2.0);
  MovingStartInputs in = inputs();
  in.heading_rad = motion.rpy_rad(kLength_s).z();
  in.lever_B_m = errors.lever_B_m;
  const auto start = start_moving(measure(motion, errors), in);
  ASSERT_TRUE(start);
  EXPECT_LT(attitude_error(motion, *start).norm(), 0.3 * kRadPerDeg);
  EXPECT_LT((start->v_N_m_s - motion.velocity_N_m_s(end_s())).norm(), 0.02);

  in.lever_B_m.setZero();
  const auto without = start_moving(measure(motion, errors), in);
  ASSERT_TRUE(without);
  EXPECT_GT((without->v_N_m_s - motion.velocity_N_m_s(end_s())).norm(), 0.5);
}

TEST(MovingStart, BiasesTurnTheAttitudeAsTheJacobiansSay) {
  for (const Motion& motion : {straight(), turn(30.0, 0.3), turn(20.0, -0.5)}) {
    const auto start = start_moving(measure(motion, {}), inputs());
    ASSERT_TRUE(start);
    for (int axis = 0; axis < 3; ++axis) {
      Errors accel;
      accel.accel_bias_B_m_s2 = 0.02 * Vector3d::Unit(axis);
      Errors gyro;
      gyro.gyro_bias_B_rad_s = 0.002 * Vector3d::Unit(axis);
      const auto by_accel = start_moving(measure(motion, accel), inputs());
      const auto by_gyro = start_moving(measure(motion, gyro), inputs());
      ASSERT_TRUE(by_accel && by_gyro);
      const Vector3d turned_by_accel = geo::log(start->q_NB * geo::conjugate(by_accel->q_NB)) / 0.02;
      const Vector3d turned_by_gyro = geo::log(start->q_NB * geo::conjugate(by_gyro->q_NB)) / 0.002;
      const double accel_scale = start->by_accel_bias.norm();
      const double gyro_scale = start->by_gyro_bias.norm();
      EXPECT_LT((turned_by_accel - start->by_accel_bias.col(axis)).norm(), 0.03 * accel_scale) << axis;
      EXPECT_LT((turned_by_gyro - start->by_gyro_bias.col(axis)).norm(), 0.03 * gyro_scale) << axis;
    }
  }
}

TEST(MovingStart, ACourseThatTurnsWithTheVelocityIsInTheCovarianceToo) {
  for (const Motion& motion : {straight(), turn(30.0, 0.3)}) {
    double joint = 0.0;
    double across = 0.0;  // what a DVL would measure: the velocity in the vehicle, free of the course
    constexpr int kDraws = 2000;
    for (int draw = 0; draw < kDraws; ++draw) {
      MovingStartInputs in = inputs();
      in.heading_sigma_rad = 1e-3;
      in.joint_course = true;
      Errors errors;
      errors.velocity_m_s = 0.5;
      const auto start = start_moving(measure(motion, errors, static_cast<std::uint64_t>(draw)), in);
      ASSERT_TRUE(start);
      const Vector3d velocity = motion.velocity_N_m_s(end_s()) - start->v_N_m_s;
      const double course = std::atan2(start->v_N_m_s.y(), start->v_N_m_s.x());
      const double speed = start->v_N_m_s.head<2>().norm();
      Eigen::Matrix<double, 2, 1> z(velocity.dot(Vector3d(-std::sin(course), std::cos(course), 0.0)),
                                    attitude_error(motion, *start).z());
      across += std::pow(z(0) - speed * z(1), 2) / kDraws;
      const Vector3d side(-std::sin(course), std::cos(course), 0.0);
      Eigen::Matrix2d p;
      const double vp = (side.transpose() * start->P_vp).z();
      p << side.dot(start->P_vv * side), vp, vp, start->P_pp(2, 2);
      joint += z.dot(p.ldlt().solve(z)) / kDraws;
    }
    EXPECT_LT(joint, 2.2);
    EXPECT_LT(std::sqrt(across), 0.1);
  }
}

TEST(MovingStart, NoiseOfTheVelocitiesIsAllInTheCovariance) {
  // Chi-squared with 3 degrees of freedom: its mean over 2,000 draws has a sigma of 0.055.
  for (const Motion& motion : {straight(), turn(30.0, 0.3)}) {
    double attitude = 0.0;
    double velocity = 0.0;
    double joint = 0.0;
    constexpr int kDraws = 2000;
    for (int draw = 0; draw < kDraws; ++draw) {
      sim::Random random(static_cast<std::uint64_t>(draw), "heading");
      MovingStartInputs in = inputs();
      in.heading_rad = motion.rpy_rad(end_s()).z() + random.normal(in.heading_sigma_rad);
      Errors errors;
      errors.velocity_m_s = 0.1;
      const auto start = start_moving(measure(motion, errors, static_cast<std::uint64_t>(draw)), in);
      ASSERT_TRUE(start);
      Eigen::Matrix<double, 6, 1> z;
      z << motion.velocity_N_m_s(end_s()) - start->v_N_m_s, attitude_error(motion, *start);
      Eigen::Matrix<double, 6, 6> p;
      p << start->P_vv, start->P_vp, start->P_vp.transpose(), start->P_pp;
      velocity += z.head<3>().dot(start->P_vv.ldlt().solve(z.head<3>())) / kDraws;
      attitude += z.tail<3>().dot(start->P_pp.ldlt().solve(z.tail<3>())) / kDraws;
      joint += z.dot(p.ldlt().solve(z)) / kDraws;
    }
    EXPECT_NEAR(velocity, 3.0, 0.3);
    EXPECT_NEAR(attitude, 3.0, 0.3);
    EXPECT_NEAR(joint, 6.0, 0.6);
  }
}

TEST(MovingStart, VelocitiesThatDisagreeMakeItUncertain) {
  Errors errors;
  errors.velocity_m_s = 0.1;
  const auto good = start_moving(measure(straight(), errors), inputs());
  errors.middle_m_s = Vector3d(0.0, 0.0, 20.0);
  const auto bad = start_moving(measure(straight(), errors), inputs());
  ASSERT_TRUE(good && bad);
  EXPECT_GT(bad->P_vv(2, 2), 100.0 * good->P_vv(2, 2));
  EXPECT_GE(bad->P_pp.trace(), good->P_pp.trace());
}

TEST(MovingStart, WhatTellsNothingStartsNothing) {
  // Up like a rocket: a course is no heading.
  const Motion up{[](double) { return Vector3d(0.0, 89.0 * kRadPerDeg, 0.3); },
                  [](double t) { return Vector3d(0.2, 0.1, -30.0 - t); }};
  EXPECT_FALSE(start_moving(measure(up, {}), inputs()));
  const Motion falling{[](double) { return Vector3d(0.0, 0.1, 0.3); },
                       [](double t) { return Vector3d(20.0, 5.0, kG * t); }};
  EXPECT_FALSE(start_moving(measure(falling, {}), inputs()));
  Errors errors;
  errors.accel_bias_B_m_s2 = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(start_moving(measure(straight(), errors), inputs()));
}

TEST(VelocityWindow, ClosesWithTheFirstVelocityThatIsOldEnough) {
  const VelocityWindow window = measure(straight(), {});
  ASSERT_TRUE(window.complete());
  EXPECT_NEAR(window.last().span.duration_s, kLength_s, 1e-6);
  ASSERT_NE(window.middle(), nullptr);
  EXPECT_NEAR(window.middle()->span.duration_s, 0.4 * kLength_s, 1e-6);
}

TEST(VelocityWindow, AVelocityInTheMiddleOfAnIntervalDividesIt) {
  // Under a force of 3 m/s^2 for two intervals of a second; the velocities come 0.25 s into either.
  VelocityWindow window;
  const Vector3d force(3.0, 0.0, 0.0);
  window.measured(kBegin + from_seconds(0.25), Vector3d::Zero(), Vector3d::Ones());
  window.add(kBegin + from_seconds(1.0), 1.0, Vector3d::Zero(), force, 1.0);
  window.measured(kBegin + from_seconds(1.25), Vector3d::Zero(), Vector3d::Ones());
  window.add(kBegin + from_seconds(2.0), 1.0, Vector3d::Zero(), force, 1.0);
  ASSERT_TRUE(window.complete());
  EXPECT_NEAR(window.last().span.duration_s, 1.0, 1e-9);
  EXPECT_NEAR(window.last().span.dv_m_s.x(), 3.0, 1e-9);
  EXPECT_NEAR(window.now().dv_m_s.x(), 3.0 * 1.75, 1e-9);
}

TEST(VelocityWindow, SilenceBeginsAnotherOne) {
  VelocityWindow window;
  const auto second = [&window](int i, bool gps) {
    if (gps) window.measured(kBegin + i * kNsPerSecond, Vector3d::Zero(), Vector3d::Ones());
    window.add(kBegin + (i + 1) * kNsPerSecond, 1.0, Vector3d::Zero(), Vector3d::UnitZ(), 3.5);
    return window.complete();
  };
  EXPECT_FALSE(second(0, true));
  for (int i = 1; i < 4; ++i) EXPECT_FALSE(second(i, false));
  EXPECT_FALSE(second(4, true)) << "the first is too old to lie on one way with it";
  EXPECT_FALSE(second(5, true));
  EXPECT_FALSE(second(6, true));
  EXPECT_FALSE(second(7, true));
  EXPECT_TRUE(second(8, true));
}

}  // namespace
}  // namespace fathom::estimation

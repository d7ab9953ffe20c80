#include "estimation/alignment/stability_gate.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "estimation/alignment/motion_level.hpp"
#include "geo/so3.hpp"

namespace fathom::estimation {
namespace {

using Eigen::Vector3d;
using Phase = StabilityGate::Phase;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kFull = 400;  // samples of 10 ms: three seconds of holding, one of averaging

StabilityInput steady(int sample) {
  StabilityInput in;
  in.dt_s = 0.01;
  in.roll_rad = in.pitch_rad = 0.0;
  in.depth_error_m = 0.5;
  in.speed_m_s = 17.0;
  in.force_B_m_s2 = {1e-3 * std::sin(sample), 0.0, -in.g_m_s2};
  return in;
}

/// Samples until the first full window; -1 when there is none.
template <class Disturb>
int samples_to_full(StabilityGate& gate, int count, Disturb disturb) {
  for (int i = 0; i < count; ++i) {
    StabilityInput in = steady(i + 1000);
    disturb(i, in);
    if (gate.add(in) == Phase::full) return i + 1;
  }
  return -1;
}

struct Fault {
  const char* name;
  StabilityReset reason;
  void (*apply)(StabilityInput& in, const StabilityInput& before);
};

class StabilityFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(StabilityFaults, ThrowTimersAndWindowAway) {
  // Once while holding, once in the middle of the window: each time everything begins anew.
  for (const int at : {120, 350}) {
    StabilityGate gate;
    for (int i = 0; i < at; ++i) gate.add(steady(i));
    EXPECT_EQ(gate.phase(), at < 300 ? Phase::waiting : Phase::averaging);
    StabilityInput bad = steady(at);
    GetParam().apply(bad, steady(at - 1));
    EXPECT_EQ(gate.add(bad), Phase::waiting);
    EXPECT_EQ(gate.last_reset(), GetParam().reason);
    for (std::size_t i = 0; i < kStabilityConditions; ++i)
      EXPECT_EQ(gate.watched(static_cast<StabilityCondition>(i)).held_s, 0.0);
    EXPECT_EQ(gate.averaged_s(), 0.0);
    EXPECT_EQ(samples_to_full(gate, 1000, [](int, StabilityInput&) {}), kFull);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, StabilityFaults,
    ::testing::Values(Fault{"nan_rate", StabilityReset::not_finite,
                            [](StabilityInput& in, const StabilityInput&) { in.rate_B_rad_s.y() = kNaN; }},
                      Fault{"nan_force", StabilityReset::not_finite,
                            [](StabilityInput& in, const StabilityInput&) { in.force_B_m_s2.z() = kNaN; }},
                      Fault{"infinite_roll", StabilityReset::not_finite,
                            [](StabilityInput& in, const StabilityInput&) { in.roll_rad = INFINITY; }},
                      Fault{"gap", StabilityReset::gap,
                            [](StabilityInput& in, const StabilityInput&) { in.dt_s = 0.021; }},
                      Fault{"stale", StabilityReset::stale,
                            [](StabilityInput& in, const StabilityInput&) { in.dt_s = -0.01; }},
                      Fault{"same_instant", StabilityReset::stale,
                            [](StabilityInput& in, const StabilityInput&) { in.dt_s = 0.0; }},
                      Fault{"repeated", StabilityReset::repeated,
                            [](StabilityInput& in, const StabilityInput& before) {
                              in.force_B_m_s2 = before.force_B_m_s2;
                            }},
                      Fault{"no_depth", StabilityReset::no_depth,
                            [](StabilityInput& in, const StabilityInput&) { in.depth_error_m = kUnknown; }},
                      Fault{"no_rpm", StabilityReset::no_speed,
                            [](StabilityInput& in, const StabilityInput&) { in.speed_m_s = kUnknown; }}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(StabilityGate, AGapOfTwentyMillisecondsIsNone) {
  StabilityGate gate;
  for (int i = 0; i < 10; ++i) {
    StabilityInput in = steady(i);
    in.dt_s = 0.02;
    gate.add(in);
  }
  EXPECT_NE(gate.last_reset(), StabilityReset::gap);
}

TEST(StabilityGate, VibrationPassesOnlyWithTheLowPass) {
  // 20 mg rms of white noise on a forward force of 0.8 m/s^2.
  const auto shake = [](StabilityGate& gate) {
    std::mt19937 engine(7);
    return samples_to_full(gate, 3000, [&](int, StabilityInput& in) {
      const auto uniform = [&] { return 2.0 * (static_cast<double>(engine()) / 4294967295.0) - 1.0; };
      const double width = 0.196 * std::sqrt(3.0);
      in.force_B_m_s2 = {0.8 + width * uniform(), width * uniform(), -9.77 + width * uniform()};
    });
  };
  StabilityGate with;
  EXPECT_GT(shake(with), 0);
  StabilityConfig plain;
  plain.low_pass_s = 0.0;
  StabilityGate without(plain);
  EXPECT_EQ(shake(without), -1);
}

TEST(StabilityGate, RefusesTurnsRestlessWindowsAndChangesOfSpeed) {
  const auto never = [](auto disturb, StabilityCondition condition) {
    StabilityGate gate;
    EXPECT_EQ(samples_to_full(gate, 1500, disturb), -1);
    EXPECT_FALSE(gate.watched(condition).met());
  };
  never([](int, StabilityInput& in) { in.rate_B_rad_s.z() = 0.1; }, StabilityCondition::rate_z);
  never([](int, StabilityInput& in) { in.force_B_m_s2.z() *= 1.06; }, StabilityCondition::gravity);
  never([](int, StabilityInput& in) { in.speed_slope_m_s2 = 0.4; }, StabilityCondition::speed_slope);
  StabilityGate gate;
  EXPECT_EQ(samples_to_full(
                gate, 900, [](int i, StabilityInput& in) { in.force_B_m_s2.y() = 0.4 * std::sin(0.05 * i); }),
            -1);
  EXPECT_EQ(gate.last_reset(), StabilityReset::spread);
}

TEST(StabilityGate, AConditionLostWhileAveragingLosesTheWindow) {
  StabilityGate gate;
  EXPECT_EQ(samples_to_full(gate, 2000,
                            [](int i, StabilityInput& in) {
                              if (i == 390) in.pitch_rad = 0.12;
                            }),
            391 + 200);  // one second of pitch, one of averaging; the roll has held all the time
  EXPECT_EQ(gate.last_reset(), StabilityReset::condition);
}

TEST(MotionLevel, RobustFormHoldsInTurnsAndAtSteepAngles) {
  for (const double roll : {-2.5, -0.3, 0.0, 0.7, 3.0})
    for (const double pitch : {-1.4, -0.2, 0.0, 1.0}) {
      const Vector3d omega(0.1, -0.2, 0.3);
      const Vector3d v(17.0, -0.4, 0.3);
      const Vector3d v_dot(0.5, -0.2, 0.1);
      const Eigen::Matrix3d c = geo::to_matrix(geo::from_rpy({roll, pitch, 0.4}));
      const Vector3d f = v_dot + geo::cross(omega, v) - c.transpose() * Vector3d(0.0, 0.0, 9.8);
      const MotionLevel got = level_in_motion(f, v_dot, omega, v);
      EXPECT_NEAR(got.roll_rad, roll, 1e-12);
      EXPECT_NEAR(got.pitch_rad, pitch, 1e-12);
    }
}

TEST(MotionLevel, RejectsInsteadOfClamping) {
  const Vector3d zero = Vector3d::Zero();
  EXPECT_EQ(level_printed({kNaN, 0.0, -9.8}, 0.0, 17.0, 9.8).fault, LevelFault::not_finite);
  EXPECT_EQ(level_printed({0.0, 0.0, -9.8}, kNaN, 17.0, 9.8).fault, LevelFault::not_finite);
  EXPECT_EQ(level_printed({9.8 * std::cos(0.0174), 0.0, 0.0}, 0.0, 17.0, 9.8).fault,
            LevelFault::forward_force);
  EXPECT_EQ(level_printed({0.0, 9.9, 0.0}, 0.0, 17.0, 9.8).fault, LevelFault::side_force);
  EXPECT_EQ(level_in_motion({kNaN, 0.0, 0.0}, zero, zero, zero).fault, LevelFault::not_finite);
  EXPECT_EQ(level_in_motion({0.2, 0.0, 0.1}, zero, zero, zero).fault, LevelFault::no_gravity);
  EXPECT_TRUE(std::isnan(level_in_motion({0.2, 0.0, 0.1}, zero, zero, zero).roll_rad));
}

}  // namespace
}  // namespace fathom::estimation

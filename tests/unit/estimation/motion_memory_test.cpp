#include "estimation/engine/motion_memory.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/units.hpp"

namespace fathom::estimation {
namespace {

/// A vehicle that turns a quarter at the beginning of each period and goes straight for the rest.
MotionMemory::Second of_circuit(int second, int period_s) {
  const int turned = second / period_s * 90 + std::min(second % period_s, 15) * 6;
  MotionMemory::Second out;
  const bool turning = second % period_s < 15;
  out.q_NB = geo::from_rpy({turning ? 0.4 : 0.0, 0.05, turned * kRadPerDeg});
  out.v_N_m_s = 40.0 * Eigen::Vector3d(std::cos(turned * kRadPerDeg), std::sin(turned * kRadPerDeg), 0.0);
  out.rate_B_rad_s = Eigen::Vector3d(0.0, 0.0, turning ? 6.0 * kRadPerDeg : 0.0);
  out.force_B_m_s2 = Eigen::Vector3d(0.0, 0.0, -9.8);
  return out;
}

TEST(MotionMemory, GoesOnInThePhaseOfThePattern) {
  // The straight parts are shorter than what is compared.
  for (int period_s = 40; period_s <= 74; period_s += 2) {
    for (int end = 330; end < 330 + period_s; end += 3) {
      MotionMemory memory;
      for (int second = 0; second < end; ++second) memory.add(of_circuit(second, period_s));
      const int next = memory.likely_next();
      ASSERT_GT(next, 0) << "period " << period_s;
      // The oldest remembered second is end - size.
      const int then = end - memory.size() + next;
      EXPECT_EQ((end - then) % period_s, 0) << "period " << period_s << ", end " << end;
    }
  }
}

TEST(MotionMemory, TakesTheOldestOfWhatIsAlike) {
  MotionMemory memory;
  for (int second = 0; second < 200; ++second) memory.add(of_circuit(20, 1000));
  EXPECT_EQ(memory.likely_next(), 60);
}

TEST(MotionMemory, SeesNoPatternInLittle) {
  MotionMemory memory;
  EXPECT_EQ(memory.likely_next(), 0);
  for (int second = 0; second < 50; ++second) memory.add(of_circuit(second, 20));
  EXPECT_EQ(memory.likely_next(), 0);
}

TEST(MotionMemory, TurnsAboutTheVerticalHoweverSteepTheAttitude) {
  for (const double pitch : {0.0, 0.7, 0.5 * std::numbers::pi, -1.5}) {
    const geo::Quaternion from = geo::from_rpy({0.3, pitch, -2.0});
    for (double turn = -3.0; turn <= 3.0; turn += 0.5)
      EXPECT_NEAR(turn_about_down_rad(from, geo::exp({0.0, 0.0, turn}) * from), turn, 1e-12);
  }
}

}  // namespace
}  // namespace fathom::estimation

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "support/orders.hpp"
#include "support/vehicles/drop_run.hpp"

namespace fathom::estimation {
namespace {

using test::Fall;
using test::feed;
using test::kEpoch;
using test::release;

TEST(DropEngine, GoesThroughThePhasesAndNavigatesOn) {
  const Fall fall(45.0);
  FusionEngine engine(test::drop_config());
  engine.start_from(release());
  std::vector<AlignmentPhase> phases;
  double aligned_s = 0.0;
  AlignmentStatus status;
  for (const auto& sample : fall.samples) {
    feed(engine, sample);
    const AlignmentPhase phase = engine.nav_state().alignment;
    if (phases.empty() || phases.back() != phase) phases.push_back(phase);
    const double t = to_seconds(engine.nav_state().header.stamp_ns - kEpoch);
    if (phase == AlignmentPhase::aligned && aligned_s == 0.0) aligned_s = t;
    if (aligned_s == 0.0 && t > 5.0 && t < 5.02) {
      engine.fill(status);
      EXPECT_EQ(status.phase, AlignmentPhase::waiting);
      EXPECT_EQ(status.condition_count, 10U);
      EXPECT_NE(std::string(status.advice.data()).find("water"), std::string::npos);
      EXPECT_GT(status.rpy_sigma_rad[0], 5.0 * kRadPerDeg);
    }
  }
  const std::vector<AlignmentPhase> wanted{AlignmentPhase::waiting, AlignmentPhase::averaging,
                                           AlignmentPhase::coarse, AlignmentPhase::fine,
                                           AlignmentPhase::aligned};
  EXPECT_EQ(phases, wanted);
  EXPECT_GT(aligned_s, 19.0);
  EXPECT_LT(aligned_s, 26.0);
  const NavState& nav = engine.nav_state();
  const Truth& truth = fall.truth.back();
  EXPECT_LT(std::abs(nav.rpy_rad[0] - truth.rpy_rad[0]), 0.4 * kRadPerDeg);
  EXPECT_LT(std::abs(nav.rpy_rad[1] - truth.rpy_rad[1]), 0.4 * kRadPerDeg);
  EXPECT_LT(std::abs(geo::wrap_pi(nav.rpy_rad[2] - truth.rpy_rad[2])), 2.0 * kRadPerDeg);
  const Eigen::Vector3d off = geo::difference_N({truth.latitude_rad, truth.longitude_rad, truth.altitude_m},
                                                {nav.latitude_rad, nav.longitude_rad, nav.altitude_m});
  const double sigma = std::sqrt(nav.position_covariance_N_m2[0] + nav.position_covariance_N_m2[4]);
  EXPECT_LT(off.head<2>().norm(), 60.0);
  EXPECT_LT(off.head<2>().norm(), 3.0 * sigma);
  EXPECT_NEAR(nav.depth_m, -truth.altitude_m, 1.0);
}

TEST(DropEngine, TheOrderOfArrivalDoesNotMatter) {
  const Fall fall(26.0);
  FusionEngine punctual(test::drop_config());
  FusionEngine late(test::drop_config());
  punctual.start_from(release());
  late.start_from(release());
  std::vector<sim::Measurement> held;
  for (const auto& sample : fall.samples) {
    feed(punctual, sample);
    const bool inertial = std::holds_alternative<ImuSample>(sample);
    if (!inertial) held.push_back(sample);
    if (inertial) feed(late, sample);
    if (held.size() >= 7) {
      for (const auto& one : held) feed(late, one);
      held.clear();
    }
  }
  for (const auto& one : held) feed(late, one);
  ImuSample last;
  for (const auto& sample : fall.samples)
    if (const auto* imu = std::get_if<ImuSample>(&sample)) last = *imu;
  last.header.stamp_ns += 10'000'000;
  punctual.add(last);
  late.add(last);
  EXPECT_EQ(punctual.nav_state().q_NB, late.nav_state().q_NB);
  EXPECT_EQ(punctual.nav_state().latitude_rad, late.nav_state().latitude_rad);
  EXPECT_EQ(punctual.nav_state().alignment, late.nav_state().alignment);
}

TEST(DropEngine, WithoutThePropulsorItNeverAlignsAndSaysWhy) {
  const Fall fall(40.0);
  FusionEngine engine(test::drop_config());
  engine.start_from(release());
  for (const auto& sample : fall.samples) {
    if (!std::holds_alternative<PropulsionSample>(sample)) feed(engine, sample);
    EXPECT_NE(engine.nav_state().alignment, AlignmentPhase::coarse);
    EXPECT_NE(engine.nav_state().alignment, AlignmentPhase::aligned);
  }
  AlignmentStatus status;
  engine.fill(status);
  EXPECT_EQ(status.phase, AlignmentPhase::timed_out);
  EXPECT_NE(std::string(status.advice.data()).find("propulsor"), std::string::npos);
}

TEST(DropEngine, AlignsAgainOnCommandUnderWay) {
  const Fall fall(60.0);
  FusionEngine engine(test::drop_config());
  engine.start_from(release());
  bool ordered = false;
  bool again = false;
  for (const auto& sample : fall.samples) {
    feed(engine, sample);
    const double t = to_seconds(engine.nav_state().header.stamp_ns - kEpoch);
    if (!ordered && t > 35.0) {
      ordered = true;
      EXPECT_EQ(engine.nav_state().alignment, AlignmentPhase::aligned);
      Command command;
      command.kind = CommandKind::realign;
      EXPECT_EQ(test::order_now(engine, command), "");
    }
    if (ordered && t > 35.1 && t < 35.2) again = engine.nav_state().alignment == AlignmentPhase::waiting;
  }
  EXPECT_TRUE(again);
  const NavState& nav = engine.nav_state();
  EXPECT_EQ(nav.alignment, AlignmentPhase::aligned);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_LT(std::abs(nav.rpy_rad[i] - fall.truth.back().rpy_rad[i]), 0.4 * kRadPerDeg);
}

}  // namespace
}  // namespace fathom::estimation

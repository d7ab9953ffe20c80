#include "estimation/engine/order.hpp"

#include <cmath>
#include <limits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "base/unknown.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "geo/wgs84.hpp"
#include "support/orders.hpp"
#include "support/vehicles/survey_run.hpp"

namespace fathom::estimation {
namespace {

using test::SurveyRun;

class OrderTest : public ::testing::Test {
 protected:
  OrderTest() : engine_(SurveyRun::config()) { go_on(40.0); }

  /// Feeds the run until that second.
  void go_on(double until_s) {
    for (; next_ < run_.samples.size(); ++next_) {
      const test::Sample& sample = run_.samples[next_];
      if (test::header(sample).received_ns > SurveyRun::kEpochNs + from_seconds(until_s)) break;
      test::feed(engine_, sample);
    }
    for (OrderOutcome one; engine_.next_outcome(one);) outcomes_.push_back(one);
  }
  [[nodiscard]] Command position(double north_m, double sigma_m = 0.1) const {
    Command out;
    out.kind = CommandKind::set_position;
    out.latitude_rad = engine_.nav_state().latitude_rad + north_m / 6.37e6;
    out.longitude_rad = engine_.nav_state().longitude_rad;
    out.sigma_m = sigma_m;
    return out;
  }
  [[nodiscard]] double moved_m() const { return engine_.nav_state().last_reset_delta_N_m[0]; }

  const SurveyRun run_{{.duration_s = 115.0, .dive_s = 1e9}};
  FusionEngine engine_;
  std::size_t next_ = 0;
  std::vector<OrderOutcome> outcomes_;
};

TEST_F(OrderTest, AFarPositionIsHeldUntilTheSameOneIsConfirmed) {
  const Command far = position(5e6);
  ASSERT_EQ(test::order_now(engine_, far), "");
  go_on(40.5);
  ASSERT_EQ(outcomes_.size(), 1U);
  EXPECT_EQ(outcomes_[0].fate, OrderFate::held);
  EXPECT_NEAR(outcomes_[0].apart_m, 5e6, 0.02 * 5e6);
  EXPECT_LT(outcomes_[0].allowed_m, 50.0);
  EXPECT_EQ(engine_.nav_state().reset_counter, 0U);

  ASSERT_EQ(test::order_now(engine_, far), "");  // again, and still not confirmed
  Command elsewhere = position(3e6);
  elsewhere.confirmed = true;
  ASSERT_EQ(test::order_now(engine_, elsewhere, 2), "");  // nobody ordered that before
  Command meant = far;
  meant.confirmed = true;
  go_on(41.0);
  EXPECT_EQ(engine_.nav_state().reset_counter, 0U);
  ASSERT_EQ(test::order_now(engine_, meant), "");
  go_on(41.5);
  EXPECT_EQ(engine_.nav_state().reset_counter, 0U) << "another one was held meanwhile";
  ASSERT_EQ(test::order_now(engine_, meant), "");
  go_on(41.6);
  ASSERT_EQ(outcomes_.size(), 5U);
  EXPECT_EQ(outcomes_.back().fate, OrderFate::done);
  EXPECT_EQ(engine_.nav_state().reset_counter, 1U);
  EXPECT_NEAR(moved_m(), 5e6, 0.02 * 5e6);
}

TEST_F(OrderTest, AConfirmationComesWithinAMinute) {
  const Command far = position(1000.0);
  ASSERT_EQ(test::order_now(engine_, far), "");
  go_on(101.0);
  Command meant = far;
  meant.confirmed = true;
  ASSERT_EQ(test::order_now(engine_, meant), "");
  go_on(101.5);
  ASSERT_EQ(outcomes_.size(), 2U);
  EXPECT_EQ(outcomes_.back().fate, OrderFate::held) << "it begins to wait anew";
  ASSERT_EQ(test::order_now(engine_, meant), "");
  go_on(102.0);
  EXPECT_EQ(outcomes_.back().fate, OrderFate::done);
}

TEST_F(OrderTest, APositionWithinTheUncertaintyIsSetAtOnce) {
  ASSERT_EQ(test::order_now(engine_, position(30.0, 10.0)), "");
  go_on(40.2);
  ASSERT_EQ(outcomes_.size(), 1U);
  EXPECT_EQ(outcomes_[0].fate, OrderFate::done);
  EXPECT_NEAR(outcomes_[0].apart_m, 30.0, 1.0);
  EXPECT_NEAR(moved_m(), 30.0, 1.0);
}

TEST_F(OrderTest, ActsAtItsStampWhenItComesLateOrEarly) {
  // The vehicle is put 30 m north at 42 s; told 2 s before that, then, and 2 s after that.
  const auto north_m = [](double told_s) {
    FusionEngine engine(SurveyRun::config());
    const SurveyRun run{{.duration_s = 46.0, .dive_s = 1e9}};
    Command order;
    bool told = false;
    std::vector<double> out;
    for (const test::Sample& sample : run.samples) {
      test::feed(engine, sample);
      const double t = to_seconds(engine.nav_state().header.stamp_ns - SurveyRun::kEpochNs);
      if (!told && t >= told_s) {
        told = true;
        order.header.stamp_ns = SurveyRun::kEpochNs + from_seconds(42.0);
        order.kind = CommandKind::set_position;
        order.latitude_rad = run.truth.front().latitude_rad + 30.0 / 6.37e6;
        order.longitude_rad = run.truth.front().longitude_rad;
        order.sigma_m = 50.0;
        EXPECT_EQ(engine.apply(order), "");
      }
      if (t > 45.0) out.push_back(engine.nav_state().latitude_rad);
    }
    return out;
  };
  const std::vector<double> then = north_m(42.0);
  ASSERT_FALSE(then.empty());
  EXPECT_EQ(north_m(40.0), then);
  EXPECT_EQ(north_m(44.0), then);
}

TEST_F(OrderTest, OutOfTimeItIsRefusedInWords) {
  Command order;
  order.kind = CommandKind::realign;
  order.header.stamp_ns = std::numeric_limits<TimeNs>::max();
  EXPECT_EQ(engine_.apply(order), "its stamp is no instant of this age");
  const TimeNs now_ns = engine_.nav_state().header.stamp_ns;
  order.header.stamp_ns = now_ns - 7 * kNsPerSecond;
  EXPECT_EQ(engine_.apply(order),
            "its stamp is 7.000 s before the newest inertial sample, expected no more than 5 s");
  order.header.stamp_ns = now_ns + 6 * kNsPerSecond;
  EXPECT_EQ(engine_.apply(order),
            "its stamp is 6.000 s after the newest inertial sample, expected no more than 5 s");
  order.header.stamp_ns = now_ns + 1;
  EXPECT_EQ(engine_.apply(order), "");
  EXPECT_EQ(engine_.apply(order), "it was given before");
  order.header.sensor = "somebody else";
  EXPECT_EQ(engine_.apply(order), "");
  FusionEngine fresh(SurveyRun::config());
  EXPECT_EQ(fresh.apply(order), "navigation has not begun");
}

TEST_F(OrderTest, WhatWaitsWhenTheTimeAxisBreaksIsSaidToBeNotDone) {
  Command order;
  order.kind = CommandKind::realign;
  order.header.stamp_ns = engine_.nav_state().header.stamp_ns + 2 * kNsPerSecond;
  ASSERT_EQ(engine_.apply(order), "");
  ImuSample imu;
  for (const test::Sample& sample : run_.samples)
    if (const auto* one = std::get_if<ImuSample>(&sample)) imu = *one;
  for (int i = 0; i < 12; ++i) {
    imu.header.stamp_ns += from_seconds(0.01) + (i == 0 ? 1000 * kNsPerSecond : 0);
    engine_.add(imu);
  }
  go_on(0.0);
  ASSERT_EQ(outcomes_.size(), 1U);
  EXPECT_EQ(outcomes_[0].fate, OrderFate::not_done);
}

// A wrong start heading put the position wrong. Somebody says where the vehicle is; that later fixes agree
// with him says nothing of the heading.
TEST(Order, APlaceThatIsToldIsNoProofOfTheHeading) {
  const SurveyRun run({.duration_s = 650.0, .dive_s = 20.0, .wave_rad = 0.0});
  FusionEngine engine(SurveyRun::config());
  std::size_t steps = 0;
  bool told = false;
  double yaw_error_rad = kUnknown;
  double yaw_sigma_rad = kUnknown;
  for (test::Sample sample : run.samples) {
    const double t_s = to_seconds(test::header(sample).stamp_ns - SurveyRun::kEpochNs);
    if (auto* heading = std::get_if<HeadingSample>(&sample)) {
      if (t_s > 18.0) continue;
      heading->heading_rad = geo::wrap_two_pi(heading->heading_rad + 0.3);
    }
    if (std::holds_alternative<UsblSample>(sample) && t_s < 520.0) continue;
    test::feed(engine, sample);
    if (!std::holds_alternative<ImuSample>(sample)) continue;
    const Truth& truth = run.truth[steps++];
    if (t_s >= 500.0 && !told) {
      told = true;
      Command order;
      order.header = truth.header;
      order.kind = CommandKind::set_position;
      order.latitude_rad = truth.latitude_rad;
      order.longitude_rad = truth.longitude_rad;
      order.sigma_m = 3.0;
      for (const bool confirmed : {false, true}) {  // it is far from where the vehicle takes itself to be
        order.header.sequence += 1;
        order.confirmed = confirmed;
        EXPECT_EQ(engine.apply(order), "");
      }
    }
    yaw_error_rad = geo::wrap_pi(engine.nav_state().rpy_rad[2] - truth.rpy_rad[2]);
    yaw_sigma_rad = engine.nav_state().rpy_sigma_rad[2];
  }
  EXPECT_TRUE(told);
  EXPECT_LT(std::abs(yaw_error_rad), 0.05);
  EXPECT_LT(std::abs(yaw_error_rad), 4.0 * yaw_sigma_rad);
}

}  // namespace
}  // namespace fathom::estimation

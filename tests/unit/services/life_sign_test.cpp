#include "fusion/life_sign.hpp"

#include <gtest/gtest.h>

namespace fathom::fusion {
namespace {

TEST(LifeSign, DroppedVerdictsAreSaidAndCounted) {
  ManualClock clock(0);
  LifeSign sign;
  LifeSign::Moment moment;
  moment.newest_nav_state_ns = clock.monotonic_ns() + 1;
  const auto told = [&] {
    ServiceStatus status;
    sign.fill(moment, clock, status);
    return status;
  };
  EXPECT_EQ(told().state, ServiceState::healthy);
  moment.counts.verdicts.dropped = 12;
  ServiceStatus status = told();
  EXPECT_EQ(status.state, ServiceState::degraded);
  EXPECT_NE(status.text.find("12 verdicts were dropped"), std::string::npos) << status.text;
  std::uint64_t counted = 0;
  for (const auto& counter : status.counters)
    if (counter.name == Name("dropped_verdicts")) counted = counter.value;
  EXPECT_EQ(counted, 12U);
  EXPECT_EQ(told().state, ServiceState::healthy) << "no more of them";
}

TEST(LifeSign, FusionWithoutCheckpointsIsDegradedAndSaysWhy) {
  ManualClock clock(0);
  LifeSign sign;
  LifeSign::Moment moment;
  moment.newest_nav_state_ns = clock.monotonic_ns() + 1;
  moment.how = "started afresh: checkpoint /run/x is not there";
  moment.checkpoints =
      CheckpointKeeper::Counts{3, 1, "/run/x.new: cannot be written: No space left on device"};
  ServiceStatus status;
  sign.fill(moment, clock, status);
  EXPECT_EQ(status.state, ServiceState::degraded);
  EXPECT_EQ(status.text,
            "a restart would begin anew: checkpoint /run/x.new: cannot be written: No space left on device");
  EXPECT_EQ(status.counter("checkpoints_failed"), 1U);
  moment.checkpoints->failure.clear();
  ServiceStatus well;
  sign.fill(moment, clock, well);
  EXPECT_EQ(well.state, ServiceState::healthy);
  EXPECT_EQ(well.text, moment.how);
}

TEST(LifeSign, AStartThatLiesAheadIsWaitedForAloud) {
  ManualClock clock(0);
  LifeSign sign;
  LifeSign::Moment moment;
  moment.newest_nav_state_ns = clock.monotonic_ns() + 1;
  moment.newest_stamp_ns = 1'700'000'000 * kNsPerSecond;
  moment.begins_ns = moment.newest_stamp_ns + 31'536'000 * kNsPerSecond;
  ServiceStatus status;
  sign.fill(moment, clock, status);
  EXPECT_EQ(status.state, ServiceState::starting);
  EXPECT_EQ(status.text, "waits for the instant of the given start, 2024-11-13T22:13:20.000Z, in 31536000 s");
  moment.newest_stamp_ns = moment.begins_ns;
  ServiceStatus begun;
  sign.fill(moment, clock, begun);
  EXPECT_EQ(begun.state, ServiceState::healthy);
}

TEST(OrderAnswers, WhyTheLastOneWasNotDoneIsSaidForAMinute) {
  ManualClock clock(0);
  runtime::Log log("fusion", runtime::LogLevel::error);
  OrderAnswers answers(log, clock);
  Command order;
  order.kind = CommandKind::realign;
  order.header.sensor = "console:anna";
  EXPECT_EQ(answers.figures().note, "");
  answers.refuse(order, "navigation has not begun");
  answers.tell({{order, estimation::OrderFate::held, false, 100.0, 10.0},
                {order, estimation::OrderFate::done, false, 0.0, 0.0}});
  const OrderAnswers::Figures figures = answers.figures();
  EXPECT_EQ(figures.note, "order realign of console:anna: refused: navigation has not begun");
  EXPECT_EQ(figures.refused, 1U);
  EXPECT_EQ(figures.held, 1U);
  EXPECT_EQ(figures.not_done, 1U);
  answers.tell({{order, estimation::OrderFate::not_done, false, 0.0, 0.0}});
  EXPECT_EQ(answers.figures().not_done, 2U);

  LifeSign sign;
  LifeSign::Moment moment;
  moment.orders = answers.figures();
  ServiceStatus status;
  sign.fill(moment, clock, status);
  EXPECT_NE(status.text.find("order realign of console:anna: not done"), std::string::npos) << status.text;
  moment.newest_nav_state_ns = clock.monotonic_ns() + 1;
  moment.how = std::string(250, 'x');  // of the 255 that go over the network
  ServiceStatus healthy;
  sign.fill(moment, clock, healthy);
  EXPECT_EQ(healthy.text.find("order realign of console:anna: not done"), 0U) << healthy.text;
  EXPECT_EQ(status.counter("orders_not_done"), 2U);
  clock.advance(61 * kNsPerSecond);
  EXPECT_EQ(answers.figures().note, "");
}

}  // namespace
}  // namespace fathom::fusion

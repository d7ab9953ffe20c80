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

}  // namespace
}  // namespace fathom::fusion

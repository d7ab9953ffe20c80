#include "runtime/clock_anchor.hpp"

#include <fstream>
#include <memory>

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fathom::runtime {
namespace {

constexpr TimeNs kUtc = 1'700'000'000 * kNsPerSecond;
constexpr DurationNs kHour = 3600 * kNsPerSecond;

class Anchor : public ::testing::Test {
 protected:
  /// What a service that starts now goes by.
  std::unique_ptr<ClockAnchor> service() const { return std::make_unique<ClockAnchor>(file, host); }

  test::TemporaryFolder folder;
  std::string file = folder.path() / "clock";
  ManualClock host{kUtc};
};

TEST_F(Anchor, ServicesThatStartAfterTheClockWasSetAgreeWithThoseBefore) {
  auto first = service();
  EXPECT_EQ(first->utc_minus_monotonic_ns(), kUtc);
  for (const DurationNs step : {kHour, -2 * kHour}) {
    host.advance(5 * kNsPerSecond);
    host.step_utc(step);
    EXPECT_EQ(service()->utc_minus_monotonic_ns(), kUtc);
  }
  // The first one ends; the next is still held by the second, and so on.
  auto second = service();
  first.reset();
  EXPECT_EQ(service()->utc_minus_monotonic_ns(), kUtc);
  EXPECT_EQ(second->trouble(), "");
}

TEST_F(Anchor, IsSetAnewWhenNobodyHoldsIt) {
  service().reset();
  host.step_utc(kHour);
  EXPECT_EQ(service()->utc_minus_monotonic_ns(), kUtc + kHour);
}

TEST_F(Anchor, WithoutAFileEachIsOnItsOwn) {
  const ClockAnchor one("", host);
  host.step_utc(kHour);
  const ClockAnchor other("", host);
  EXPECT_EQ(one.utc_minus_monotonic_ns(), kUtc);
  EXPECT_EQ(other.utc_minus_monotonic_ns(), kUtc + kHour);
  EXPECT_EQ(other.trouble(), "");
}

TEST_F(Anchor, AFileThatCannotBeUsedIsNamed) {
  const ClockAnchor nowhere(folder.path() / "missing" / "clock", host);
  EXPECT_EQ(nowhere.utc_minus_monotonic_ns(), kUtc);
  EXPECT_NE(nowhere.trouble().find("missing/clock cannot be opened"), std::string::npos) << nowhere.trouble();
  const auto holder = service();
  for (const char* damaged : {"", "soon\n", "17", "99999999999999999999999\n"}) {
    std::ofstream(file, std::ios::trunc) << damaged;
    const auto after = service();
    EXPECT_EQ(after->utc_minus_monotonic_ns(), kUtc);
    EXPECT_NE(after->trouble().find("holds no clock anchor"), std::string::npos) << damaged;
  }
}

TEST(AnchoredClock, GoesOnWithTheMonotonicClock) {
  const SystemClock host;
  const AnchoredClock clock(kHour);
  const TimeNs before = host.monotonic_ns();
  const TimeNs now = clock.utc_ns() - kHour;
  EXPECT_LE(before, now);
  EXPECT_LE(now, host.monotonic_ns());
}

}  // namespace
}  // namespace fathom::runtime

#include "base/time.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "base/clock.hpp"
#include "base/iso8601.hpp"
#include "base/name.hpp"
#include "base/unknown.hpp"

namespace fathom {
namespace {

TEST(Time, CivilTimesOfKnownInstants) {
  EXPECT_EQ(from_civil({1970, 1, 1, 0, 0, 0, 0}), 0);
  EXPECT_EQ(from_civil({2000, 2, 29, 12, 0, 0, 0}), 951'825'600 * kNsPerSecond);
  EXPECT_EQ(from_civil({2026, 11, 21, 0, 0, 0, 5}), 1'795'219'200 * kNsPerSecond + 5);
  // A leap second is the first instant of the next minute; u-blox gives negative nanoseconds.
  EXPECT_EQ(from_civil({2016, 12, 31, 23, 59, 60, 0}), from_civil({2017, 1, 1, 0, 0, 0, 0}));
  EXPECT_EQ(*from_civil({2020, 1, 1, 0, 0, 0, -250}) + 250, from_civil({2020, 1, 1, 0, 0, 0, 0}));
}

TEST(Time, RefusesWhatIsNotOnTheCalendar) {
  const CivilTime bad[] = {
      {2021, 2, 29, 0, 0, 0, 0},          {2021, 13, 1, 0, 0, 0, 0},  {2021, 0, 1, 0, 0, 0, 0},
      {2021, 4, 31, 0, 0, 0, 0},          {2021, 1, 1, 24, 0, 0, 0},  {2021, 1, 1, 0, 60, 0, 0},
      {2021, 1, 1, 0, 0, 61, 0},          {1969, 12, 31, 0, 0, 0, 0}, {2262, 1, 1, 0, 0, 0, 0},
      {2021, 1, 1, 0, 0, -1, 0},          {2021, 1, 0, 0, 0, 0, 0},   {1900, 2, 29, 0, 0, 0, 0},
      {2021, 1, 1, 0, 0, 0, kNsPerSecond}};
  for (const auto& civil : bad)
    EXPECT_FALSE(from_civil(civil)) << civil.year << '-' << civil.month << '-' << civil.day;
}

TEST(Time, CivilRoundTripOverThreeCenturies) {
  for (TimeNs day = 0; day < 106'000; day += 13) {
    const TimeNs instant = (day * 86'400 + day % 86'400) * kNsPerSecond + 123'456'789;
    EXPECT_EQ(from_civil(to_civil(instant)), instant);
  }
}

TEST(Time, Iso8601) {
  EXPECT_EQ(to_iso8601(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(to_iso8601(1'500'000'000, 9), "1970-01-01T00:00:01.500000000Z");
  EXPECT_EQ(to_iso8601(1'999'999'999, 0), "1970-01-01T00:00:01Z");
  EXPECT_EQ(to_iso8601(-1, 3), "1969-12-31T23:59:59.999Z");
}

TEST(Time, SecondsSaturateAndNaNIsZero) {
  EXPECT_EQ(from_seconds(0.25), 250'000'000);
  EXPECT_EQ(from_seconds(-1e-9), -1);
  EXPECT_EQ(from_seconds(1e12), std::numeric_limits<DurationNs>::max());
  EXPECT_EQ(from_seconds(-1e12), std::numeric_limits<DurationNs>::min());
  EXPECT_EQ(from_seconds(kUnknown), 0);
}

TEST(Clock, ScaledClockRunsAtItsRateFromItsEpoch) {
  const SystemClock host;
  const TimeNs epoch = host.utc_ns();
  const ScaledClock clock(epoch, 10.0);
  const TimeNs host_before = host.utc_ns();
  const TimeNs scaled = clock.utc_ns();
  const TimeNs host_after = host.utc_ns();
  // Whatever the scheduler does in between, the scaled reading lies between ten times the two host readings.
  EXPECT_GE(scaled, epoch + 10 * (host_before - epoch) - 100 * kNsPerMillisecond);
  EXPECT_LE(scaled, epoch + 10 * (host_after - epoch) + 100 * kNsPerMillisecond);
  EXPECT_EQ(clock.rate(), 10.0);
}

TEST(Clock, TwoScaledClocksOfOneEpochAgree) {
  const TimeNs epoch = SystemClock().utc_ns();
  const ScaledClock a(epoch, 4.0);
  const ScaledClock b(epoch, 4.0);
  const TimeNs first = a.utc_ns();
  const TimeNs between = b.utc_ns();
  const TimeNs last = a.utc_ns();
  EXPECT_GE(between, first - kNsPerMillisecond);
  EXPECT_LE(between, last + kNsPerMillisecond);
}

TEST(Clock, ManualClockStepsUtcAlone) {
  ManualClock clock(1000);
  clock.advance(5);
  clock.step_utc(-3600 * kNsPerSecond);
  EXPECT_EQ(clock.monotonic_ns(), 5);
  EXPECT_EQ(clock.utc_ns(), 1005 - 3600 * kNsPerSecond);
}

TEST(SystemClock, BootTimeIsNeverBehindTheMonotonicOne) {
  const SystemClock host;
  const TimeNs monotonic_ns = host.monotonic_ns();
  const TimeNs boottime_ns = host.boottime_ns();
  EXPECT_GE(boottime_ns, monotonic_ns) << "it also counts what the host slept";
  EXPECT_GE(host.boottime_ns(), boottime_ns);
}

TEST(Name, KeepsThirtyOneBytesInPlace) {
  const Name name("0123456789012345678901234567890123456789");
  EXPECT_EQ(name.view(), "0123456789012345678901234567890");
  EXPECT_EQ(std::string(name.c_str()).size(), Name::kCapacity);
  EXPECT_TRUE(Name().empty());
  EXPECT_EQ(Name("gps0"), Name(std::string_view("gps0")));
  EXPECT_LT(Name("a"), Name("b"));
  EXPECT_NE(Name("a"), Name("aa"));
  EXPECT_TRUE(std::is_trivially_copyable_v<Name>);
}

TEST(Iso8601, ReadsBackWhatItWrites) {
  for (const TimeNs utc : {TimeNs{0}, TimeNs{1'577'836'799'999'999'999}, TimeNs{1'900'000'000'123'456'789}}) {
    const auto read = from_iso8601(to_iso8601(utc, 9));
    ASSERT_TRUE(read) << to_iso8601(utc, 9);
    EXPECT_LE(std::abs(*read - utc), 10) << "a double has 16 digits";
  }
  for (const char* text :
       {"", "2026", "2026-01-31T12:00:00", "2026-01-31T12:00:00+01:00", "2026-13-01T00:00:00Z",
        "2026-01-31T12:00:61Z", "2026-01-31T12:00:-1Z", "2026-01-31T12:00:00Zulu"})
    EXPECT_FALSE(from_iso8601(text)) << text;
}

}  // namespace
}  // namespace fathom

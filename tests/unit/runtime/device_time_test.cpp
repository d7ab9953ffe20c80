#include "runtime/device_time.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

namespace fathom::runtime {
namespace {

constexpr DurationNs kMs = kNsPerMillisecond;
constexpr TimeNs kStart = 1'700'000'000LL * kNsPerSecond;
constexpr TimeNs kDay = 86'400 * kNsPerSecond;

// Repeatable noise in [0, 1).
class Noise {
 public:
  double next() {
    state_ = state_ * 6'364'136'223'846'793'005ULL + 1'442'695'040'888'963'407ULL;
    return static_cast<double>(state_ >> 11) * 0x1.0p-53;
  }

 private:
  std::uint64_t state_ = 12345;
};

// The host's monotonic clock counts from elsewhere than its UTC.
Arrival at(TimeNs utc) {
  return {utc, utc - kStart + 77 * kNsPerSecond};
}

DeviceTime clock_of(TimeNs ns) {
  DeviceTime out;
  out.clock_ns = ns;
  return out;
}

DeviceTime utc_of(TimeNs ns) {
  DeviceTime out;
  out.utc_ns = ns;
  return out;
}

TimeConfig tracked(double minimum_latency_s = 0.002) {
  TimeConfig out;
  out.mode = TimeMode::device_clock;
  out.minimum_latency_s = minimum_latency_s;
  return out;
}

TEST(ArrivalTime, TakesLatencyAndAgeOff) {
  TimeConfig config;
  config.latency_s = 0.05;
  DeviceTimeTracker tracker(config);
  EXPECT_EQ(tracker.stamp({}, at(kStart)).utc_ns, kStart - 50 * kMs);
  DeviceTime aged;
  aged.age_ns = 630 * kMs;
  EXPECT_EQ(tracker.stamp(aged, at(kStart + kNsPerSecond)).utc_ns, kStart + kNsPerSecond - 680 * kMs);
  aged.age_ns = -5 * kMs;  // an instrument that speaks before it measures
  EXPECT_EQ(tracker.stamp(aged, at(kStart + 2 * kNsPerSecond)).utc_ns, kStart + 2 * kNsPerSecond - 50 * kMs);
}

TEST(DeviceUtc, IsTakenWhenItCanBe) {
  TimeConfig config;
  config.mode = TimeMode::device_utc;
  DeviceTimeTracker tracker(config);
  const Stamp stamp = tracker.stamp(utc_of(kStart - 130 * kMs), at(kStart));
  EXPECT_EQ(stamp.utc_ns, kStart - 130 * kMs);
  EXPECT_FALSE(stamp.from_arrival);
}

TEST(DeviceUtc, UnbelievableTimeIsReplacedByTheArrival) {
  TimeConfig config;
  config.mode = TimeMode::device_utc;
  config.latency_s = 0.1;
  config.max_age_s = 5.0;
  config.tolerance_s = 0.02;
  DeviceTimeTracker tracker(config);
  for (const TimeNs wrong : {kStart - 6 * kNsPerSecond, kStart + 30 * kMs, TimeNs{0}}) {
    const Stamp stamp = tracker.stamp(utc_of(wrong), at(kStart));
    EXPECT_EQ(stamp.utc_ns, kStart - 100 * kMs);
    EXPECT_TRUE(stamp.from_arrival);
    EXPECT_TRUE(stamp.implausible);
  }
  EXPECT_EQ(tracker.stamp(utc_of(kStart + 10 * kMs), at(kStart)).utc_ns, kStart + 10 * kMs);
}

TEST(DeviceUtc, WeekRollOverIsCorrected) {
  TimeConfig config;
  config.mode = TimeMode::device_utc;
  DeviceTimeTracker tracker(config);
  const TimeNs valid = kStart - 200 * kMs;
  const Stamp stamp = tracker.stamp(utc_of(valid - 1024 * 7 * kDay), at(kStart));
  EXPECT_EQ(stamp.utc_ns, valid);
  EXPECT_TRUE(stamp.week_rollover);
  EXPECT_FALSE(stamp.implausible);
}

TEST(DeviceUtc, TimeOfDayTakesTheDateOfItsArrivalAlsoAtMidnight) {
  TimeConfig config;
  config.mode = TimeMode::device_utc;
  DeviceTimeTracker tracker(config);
  const TimeNs midnight = kStart - kStart % kDay + kDay;
  DeviceTime before;
  before.time_of_day_ns = kDay - 100 * kMs;
  EXPECT_EQ(tracker.stamp(before, at(midnight + 50 * kMs)).utc_ns, midnight - 100 * kMs);
  DeviceTime after;
  after.time_of_day_ns = 20 * kMs;
  EXPECT_EQ(tracker.stamp(after, at(midnight + 150 * kMs)).utc_ns, midnight + 20 * kMs);
  // Slightly fast receiver: its day has begun, the host's has not.
  EXPECT_EQ(tracker.stamp(after, at(midnight - 10 * kMs)).utc_ns, midnight + 20 * kMs);
}

TEST(DeviceUtc, TimeThatGoesBackIsFlaggedAndKept) {
  TimeConfig config;
  config.mode = TimeMode::device_utc;
  DeviceTimeTracker tracker(config);
  EXPECT_FALSE(tracker.stamp(utc_of(kStart - 100 * kMs), at(kStart)).backwards);
  EXPECT_FALSE(tracker.stamp(utc_of(kStart - 100 * kMs), at(kStart + 10 * kMs)).backwards);
  const Stamp back = tracker.stamp(utc_of(kStart - 1100 * kMs), at(kStart + 100 * kMs));
  EXPECT_TRUE(back.backwards);
  EXPECT_EQ(back.utc_ns, kStart - 1100 * kMs);
}

TEST(DeviceUtc, FrameWithoutTimeIsStampedByArrival) {
  TimeConfig config;
  config.mode = TimeMode::device_utc;
  config.latency_s = 0.25;
  DeviceTimeTracker tracker(config);
  const Stamp stamp = tracker.stamp({}, at(kStart));
  EXPECT_EQ(stamp.utc_ns, kStart - 250 * kMs);
  EXPECT_TRUE(stamp.from_arrival);
  EXPECT_FALSE(stamp.implausible);
}

// A device at `rate_hz` whose clock runs drift_ppm fast of the host's, with delays of 2 ms and more.
struct Device {
  double drift_ppm = 0.0;
  DurationNs offset = -5 * kNsPerSecond;  ///< its clock at kStart
  Noise noise;

  TimeNs clock(TimeNs utc) const {
    return offset + (utc - kStart) +
           static_cast<TimeNs>(static_cast<double>(utc - kStart) * drift_ppm * 1e-6);
  }
  DurationNs delay() {
    const double u = noise.next();
    return 2 * kMs + static_cast<DurationNs>(u * u * u * 15.0 * static_cast<double>(kMs));  // a long tail
  }
};

TEST(DeviceClock, JitterAndDriftAreRemoved) {
  for (const double drift_ppm : {0.0, 80.0, -80.0}) {
    DeviceTimeTracker tracker(tracked());
    Device device{drift_ppm, -5 * kNsPerSecond, {}};
    double worst_s = 0.0;
    for (int i = 0; i < 60'000; ++i) {  // ten minutes at 100 Hz
      const TimeNs valid = kStart + i * 10 * kMs;
      const TimeNs arrived = valid + device.delay();
      const Stamp stamp = tracker.stamp(clock_of(device.clock(valid)), at(arrived));
      EXPECT_LE(stamp.utc_ns, arrived);
      EXPECT_FALSE(stamp.backwards);
      EXPECT_FALSE(stamp.clock_step);
      if (i > 500) worst_s = std::max(worst_s, std::abs(to_seconds(stamp.utc_ns - valid)));
    }
    EXPECT_LT(worst_s, 0.0005) << drift_ppm << " ppm";
  }
}

TEST(DeviceClock, WhatAFrameSaysOfItsAgeIsItsLeastDelay) {
  // An instrument that sends some 0.6 s after it measured, and says how long; on its way it takes 1 ms and
  // more.
  for (const double minimum_latency_s : {0.0, 0.05}) {
    DeviceTimeTracker tracker(tracked(minimum_latency_s));
    Device device{40.0, -5 * kNsPerSecond, {}};
    Noise ranges;
    double worst_s = 0.0;
    for (int i = 0; i < 600; ++i) {
      const TimeNs valid = kStart + i * kNsPerSecond;
      DeviceTime said = clock_of(device.clock(valid));
      said.age_ns = 600 * kMs + static_cast<DurationNs>(ranges.next() * 40.0 * static_cast<double>(kMs));
      const TimeNs arrived = valid + *said.age_ns + device.delay() - kMs;
      if (i == 0) tracker.foresee(said, at(arrived));
      const Stamp stamp = tracker.stamp(said, at(arrived));
      EXPECT_FALSE(stamp.from_arrival);
      EXPECT_FALSE(stamp.clock_step);
      EXPECT_LE(stamp.utc_ns, arrived - *said.age_ns);
      worst_s = std::max(worst_s, std::abs(to_seconds(stamp.utc_ns - valid)));
    }
    EXPECT_LT(worst_s, 0.018) << minimum_latency_s;
  }
}

TEST(DeviceClock, AnAgeBelowTheConfiguredLatencyChangesNothing) {
  DeviceTimeTracker plain(tracked(0.2));
  DeviceTimeTracker aged(tracked(0.2));
  for (int i = 0; i < 100; ++i) {
    DeviceTime said = clock_of(i * 100 * kMs);
    const Arrival arrival = at(kStart + i * 100 * kMs + 200 * kMs + i % 7 * kMs);
    const TimeNs expected = plain.stamp(said, arrival).utc_ns;
    said.age_ns = 190 * kMs;
    EXPECT_EQ(aged.stamp(said, arrival).utc_ns, expected);
  }
}

TEST(DeviceClock, ABurstAfterAStallKeepsTheDevicesSpacing) {
  DeviceTimeTracker tracker(tracked());
  for (int i = 0; i < 100; ++i)
    (void)tracker.stamp(clock_of(i * 10 * kMs), at(kStart + i * 10 * kMs + 2 * kMs));
  // Half a second of frames arrives at once.
  const TimeNs arrived = kStart + 1500 * kMs;
  for (int i = 100; i < 150; ++i) {
    EXPECT_NEAR(to_seconds(tracker.stamp(clock_of(i * 10 * kMs), at(arrived)).utc_ns - kStart), i * 0.01,
                1e-4);
  }
}

TEST(DeviceClock, FramesThatGatheredBeforeTheFirstReadKeepTheDevicesSpacing) {
  DeviceTimeTracker tracker(tracked());
  const TimeNs read = kStart + 85 * kMs;
  for (int i = 0; i < 8; ++i) tracker.foresee(clock_of(5 * kNsPerSecond + i * 10 * kMs), at(read));
  for (int i = 0; i < 8; ++i) {
    const Stamp stamp = tracker.stamp(clock_of(5 * kNsPerSecond + i * 10 * kMs), at(read));
    EXPECT_EQ(stamp.utc_ns, read - 2 * kMs - (7 - i) * 10 * kMs) << i;
    EXPECT_FALSE(stamp.from_arrival);
  }
  // What arrives later is no news of the first ones.
  tracker.foresee(clock_of(7 * kNsPerSecond), at(read + 10 * kMs));
  EXPECT_EQ(tracker.stamp(clock_of(5 * kNsPerSecond + 80 * kMs), at(read + 10 * kMs)).utc_ns, read + 8 * kMs);
}

TEST(DeviceClock, ADamagedTimeAmongTheFirstIsNotForeseen) {
  DeviceTimeTracker tracker(tracked());
  tracker.foresee(clock_of(5 * kNsPerSecond), at(kStart));
  tracker.foresee(clock_of(4'000 * kNsPerSecond), at(kStart));
  tracker.foresee(clock_of(5 * kNsPerSecond + 10 * kMs), at(kStart));
  EXPECT_EQ(tracker.stamp(clock_of(5 * kNsPerSecond), at(kStart)).utc_ns, kStart - 12 * kMs);
}

TEST(DeviceClock, FirstFrameThatWasDelayedCausesNoStampAfterArrivalAndNoReversal) {
  DeviceTimeTracker tracker(tracked());
  TimeNs last = 0;
  for (int i = 0; i < 400; ++i) {
    const TimeNs valid = kStart + i * 10 * kMs;
    const TimeNs arrived = valid + (i == 0 ? 300 * kMs : 2 * kMs);
    if (i > 0 && arrived < kStart + 300 * kMs) continue;  // they waited behind the first
    const Stamp stamp = tracker.stamp(clock_of(i * 10 * kMs), at(arrived));
    EXPECT_LE(stamp.utc_ns, arrived);
    EXPECT_GE(stamp.utc_ns, last);
    last = stamp.utc_ns;
    if (i > 200) {
      EXPECT_NEAR(to_seconds(stamp.utc_ns - valid), 0.0, 1e-4);
    }
  }
}

TEST(DeviceClock, RestartIsNoticedAndFollowed) {
  DeviceTimeTracker tracker(tracked());
  for (int i = 0; i < 500; ++i)
    (void)tracker.stamp(clock_of(i * 10 * kMs), at(kStart + i * 10 * kMs + 2 * kMs));
  const TimeNs again = kStart + 8 * kNsPerSecond;
  int steps = 0;
  for (int i = 0; i < 100; ++i) {
    const Stamp stamp = tracker.stamp(clock_of(i * 10 * kMs), at(again + i * 10 * kMs + 2 * kMs));
    steps += stamp.clock_step ? 1 : 0;
    EXPECT_NEAR(to_seconds(stamp.utc_ns - again), i * 0.01, 1e-4);
  }
  EXPECT_EQ(steps, 1);
  EXPECT_EQ(tracker.clock_steps(), 1U);
}

TEST(DeviceClock, OneDamagedTimeMovesNothing) {
  for (const DurationNs damage : {3600 * kNsPerSecond, -3600 * kNsPerSecond}) {
    DeviceTimeTracker tracker(tracked());
    for (int i = 0; i < 1000; ++i) {
      const TimeNs said = i * 10 * kMs + (i == 500 ? damage : 0);
      const Stamp stamp = tracker.stamp(clock_of(said), at(kStart + i * 10 * kMs + 2 * kMs));
      EXPECT_NEAR(to_seconds(stamp.utc_ns - kStart), i * 0.01, 1e-4);
      EXPECT_EQ(stamp.from_arrival, i == 500);
      EXPECT_FALSE(stamp.clock_step);
    }
  }
}

TEST(DeviceClock, SmallStepBackIsForgottenAfterAWindow) {
  DeviceTimeTracker tracker(tracked());
  Stamp stamp;
  for (int i = 0; i < 4000; ++i) {
    const TimeNs said = i * 10 * kMs - (i >= 1000 ? 300 * kMs : 0);
    stamp = tracker.stamp(clock_of(said), at(kStart + i * 10 * kMs + 2 * kMs));
  }
  EXPECT_NEAR(to_seconds(stamp.utc_ns - kStart), 39.99, 1e-4);
}

TEST(DeviceClock, CounterRollOver) {
  TimeConfig config = tracked();
  config.rollover_s = 4.294967296;  // 32 bits of nanoseconds
  DeviceTimeTracker tracker(config);
  constexpr TimeNs kPeriod = 4'294'967'296;
  for (int i = 0; i < 2000; ++i) {
    const Stamp stamp =
        tracker.stamp(clock_of((i * 10 * kMs) % kPeriod), at(kStart + i * 10 * kMs + 2 * kMs));
    EXPECT_FALSE(stamp.clock_step);
    EXPECT_FALSE(stamp.from_arrival);
    EXPECT_NEAR(to_seconds(stamp.utc_ns - kStart), i * 0.01, 1e-4);
  }
}

TEST(DeviceClock, AStepOfTheHostsUtcMovesTheStampsWithIt) {
  DeviceTimeTracker tracker(tracked());
  for (int i = 0; i < 1000; ++i) {
    Arrival arrival = at(kStart + i * 10 * kMs + 2 * kMs);
    const DurationNs step = i >= 500 ? 3 * kNsPerSecond : 0;
    arrival.utc_ns += step;
    const Stamp stamp = tracker.stamp(clock_of(i * 10 * kMs), arrival);
    EXPECT_NEAR(to_seconds(stamp.utc_ns - step - kStart), i * 0.01, 1e-4);
    EXPECT_FALSE(stamp.clock_step);
  }
}

TEST(DeviceClock, ANewConnectionStartsAnew) {
  DeviceTimeTracker tracker(tracked());
  for (int i = 0; i < 10; ++i)
    (void)tracker.stamp(clock_of(i * 10 * kMs), at(kStart + i * 10 * kMs + 2 * kMs));
  tracker.reset();
  const Stamp stamp = tracker.stamp(clock_of(0), at(kStart + kNsPerSecond));
  EXPECT_EQ(stamp.utc_ns, kStart + kNsPerSecond - 2 * kMs);
  EXPECT_FALSE(stamp.clock_step);
}

}  // namespace
}  // namespace fathom::runtime

// What late measurements cost where they come regularly, and where they do not.

#include "estimation/engine/anticipation.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "estimation/engine/fusion_engine.hpp"

namespace fathom::estimation {
namespace {

constexpr TimeNs kEpochNs = 1'700'000'000 * kNsPerSecond;
constexpr DurationNs kStepNs = 10'000'000;
constexpr int kSteps = 4000;
constexpr geo::Geodetic kStart{0.6, 0.2, -20.0};

/// Inertial steps done again for each measurement, of a vehicle that lies still under water; depths come
/// every `period_ns`, stamped as `stamp` moves the stamp number n, and `delay_ns` later.
double repeated_for_each(
    DurationNs period_ns, DurationNs delay_ns,
    const std::function<DurationNs(int)>& moved_ns = [](int) { return DurationNs{0}; }) {
  EngineConfig config;
  config.imu.nominal_rate_hz = 100.0;
  config.sensors = {default_sensor(SourceKind::depth, "depth0")};
  FusionEngine engine(config);
  InitialState start;
  start.latitude_rad = kStart.latitude_rad;
  start.longitude_rad = kStart.longitude_rad;
  start.altitude_m = kStart.altitude_m;
  engine.start_from(start);
  const geo::LocalEarth earth(kStart);
  int taken = 0;
  std::uint64_t before = 0;
  for (int k = 1, next = 1; k <= kSteps; ++k) {
    ImuSample imu;
    imu.header.sensor = "imu";
    imu.header.stamp_ns = imu.header.received_ns = kEpochNs + k * kStepNs;
    imu.header.sequence = static_cast<std::uint64_t>(k);
    imu.angular_rate_B_rad_s = geo::arr(earth.earth_rate_N);
    imu.specific_force_B_m_s2 = {0.0, 0.0, -earth.gravity_m_s2};
    engine.add(imu);
    if (k == kSteps / 2) {
      before = engine.repeated_steps();
      taken = 0;
    }
    for (; k * kStepNs >= next * period_ns + delay_ns; ++next) {
      DepthSample depth;
      depth.header.sensor = "depth0";
      depth.header.stamp_ns = kEpochNs + next * period_ns + moved_ns(next);
      depth.header.received_ns = imu.header.received_ns;
      depth.header.sequence = static_cast<std::uint64_t>(next);
      depth.depth_m = 20.0 + 1e-3 * (next % 7);
      engine.add(depth);
      ++taken;
    }
  }
  return static_cast<double>(engine.repeated_steps() - before) / taken;
}

TEST(Anticipation, RegularMeasurementsRepeatWhatFollowsThemAndNoMore) {
  // The step in which the stamp lies, and those up to the arrival.
  EXPECT_LT(repeated_for_each(100'000'000, 45'000'000), 6.0 + 0.1);
  EXPECT_LT(repeated_for_each(100'000'000, 345'000'000), 36.0 + 0.1) << "several on their way at once";
  EXPECT_LT(repeated_for_each(1'000'000'000, 1'505'000'000), 152.0 + 0.1);
  EXPECT_LT(repeated_for_each(133'000'000, 77'000'000), 9.0 + 0.5) << "stamps anywhere in a step";
}

TEST(Anticipation, LostMeasurementsAndJitterCostLittle) {
  const auto jitter = [](int n) { return DurationNs{1'000'000} * ((n * 7) % 3 - 1); };
  EXPECT_LT(repeated_for_each(100'000'000, 45'000'000, jitter), 6.0 + 1.7);
  const auto wild = [](int n) { return DurationNs{1'000'000} * ((n * 37) % 61 - 30); };
  // As far as nothing is foreseen, an eighth of the age and two steps.
  EXPECT_LT(repeated_for_each(100'000'000, 345'000'000, wild), 1.25 * 39.0 + 3.0);
}

TEST(Anticipation, NothingIsExpectedOfWhoComesInTimeOrHasFallenSilent) {
  Anticipation anticipation;
  Measurement depth;
  depth.sensor = 3;
  const auto hear = [&](TimeNs stamp_ns, DurationNs delay_ns) {
    depth.stamp_ns = stamp_ns;
    anticipation.heard(depth, stamp_ns + delay_ns);
  };
  const TimeNs t = kEpochNs;
  const DurationNs period = 100'000'000;
  hear(t, 50'000'000);
  EXPECT_EQ(anticipation.expected_until_ns(t + period - kStepNs, kStepNs), 0) << "one is no period";
  hear(t + period, 50'000'000);
  EXPECT_EQ(anticipation.expected_until_ns(t + 2 * period - kStepNs, kStepNs),
            t + 2 * period + 50'000'000 + kStepNs);
  EXPECT_EQ(anticipation.expected_until_ns(t + 2 * period, kStepNs), 0);
  EXPECT_GT(anticipation.expected_until_ns(t + 3 * period - kStepNs, kStepNs), 0) << "one may be lost";
  EXPECT_EQ(anticipation.expected_until_ns(t + 100 * period - kStepNs, kStepNs), 0);
  EXPECT_EQ(anticipation.expected_until_ns(t + 3 * period - 2 * period / 3, period / 3), 0)
      << "steps as long as that stand close enough";
  hear(t + 2 * period, -5'000'000);
  EXPECT_EQ(anticipation.expected_until_ns(t + 3 * period - kStepNs, kStepNs), 0);
}

}  // namespace
}  // namespace fathom::estimation

// Mistakes that are drawn, in motions that are drawn: none is given another's name, and instruments that are
// only as bad as their sheets allow are left alone.
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "estimation/navigator/plausibility/plausibility.hpp"
#include "sim/random.hpp"
#include "support/sanitized.hpp"
#include "support/vehicles/plausibility_run.hpp"

namespace fathom::estimation {
namespace {

using test::change_of;
using test::kDriveEpoch_ns;
using test::PlausibilityRun;
using test::SampleChange;

constexpr std::uint64_t kFirstSeed = 1001;
constexpr int kDraws = 6;  ///< of each mistake

int whole(sim::Random& random, int count) {
  return std::min(count - 1, static_cast<int>(random.uniform(0.0, count)));
}

struct Drawn {
  std::set<std::string> names;  ///< any of which says it
  SampleChange change;
};

/// One of each kind of mistake, at a size that is drawn.
std::vector<Drawn> mistakes(sim::Random& random) {
  std::vector<Drawn> out;
  const auto imu = [&](std::set<std::string> names, std::function<void(ImuSample&)> change) {
    out.push_back({std::move(names), change_of<ImuSample>(std::move(change))});
  };
  // Turns of the accelerometer that take gravity off the down axis.
  const int axis = whole(random, 2);
  imu({"force_along_x", "force_along_y"}, [axis](ImuSample& s) {
    std::swap(s.specific_force_B_m_s2[static_cast<std::size_t>(axis)], s.specific_force_B_m_s2[2]);
  });
  imu({"force_downwards"}, [](ImuSample& s) { s.specific_force_B_m_s2[2] *= -1.0; });
  imu({"gyro_negated", "gyro_axes"}, [](ImuSample& s) { s.angular_rate_B_rad_s[2] *= -1.0; });
  const double sign = random.uniform(0.0, 1.0) < 0.5 ? 1.0 : -1.0;
  imu({"gyro_too_slow"}, [sign](ImuSample& s) {
    for (double& one : s.angular_rate_B_rad_s) one *= sign * kRadPerDeg;
  });
  // Farther off it is another setting, and no clock.
  const double rate =
      random.uniform(0.0, 1.0) < 0.5 ? random.uniform(0.87, 0.93) : random.uniform(1.07, 1.13);
  imu({"imu_rate"}, [rate](ImuSample& s) {
    s.header.stamp_ns =
        kDriveEpoch_ns + static_cast<TimeNs>(static_cast<double>(s.header.stamp_ns - kDriveEpoch_ns) / rate);
  });
  const double angle =
      (random.uniform(0.0, 1.0) < 0.5 ? 1.0 : -1.0) * random.uniform(40.0, 180.0) * kRadPerDeg;
  out.push_back({{"dvl_turned"}, change_of<DvlSample>([angle](DvlSample& s) {
                   const double x = s.velocity_D_m_s[0];
                   const double y = s.velocity_D_m_s[1];
                   s.velocity_D_m_s[0] = std::cos(angle) * x - std::sin(angle) * y;
                   s.velocity_D_m_s[1] = std::sin(angle) * x + std::cos(angle) * y;
                 })});
  constexpr std::array kSpeeds{100.0, 1000.0, 3600.0 / 1852.0, 1.0 / 0.3048};
  const double unit = kSpeeds[static_cast<std::size_t>(whole(random, 4))];
  out.push_back({{"dvl_unit"}, change_of<DvlSample>([unit](DvlSample& s) {
                   for (double& one : s.velocity_D_m_s) one *= unit;
                 })});
  constexpr std::array kGpsSpeeds{100.0, 1000.0, 3.6, 3600.0 / 1852.0};
  const double gps = kGpsSpeeds[static_cast<std::size_t>(whole(random, 4))];
  out.push_back({{"gps_unit"}, change_of<GpsSample>([gps](GpsSample& s) {
                   for (double& one : s.velocity_N_m_s) one *= gps;
                 })});
  constexpr std::array kDepths{0.1, 100.0, 1.0 / 0.3048, -1.0};
  const double depth = kDepths[static_cast<std::size_t>(whole(random, 4))];
  out.push_back({{depth < 0.0 ? "depth_upwards" : "depth_unit"},
                 change_of<DepthSample>([depth](DepthSample& s) { s.depth_m *= depth; })});
  return out;
}

TEST(PlausibilityDrawn, NoMistakeIsGivenAnothersNameAndMostAreNamedWithinAMinute) {
  FATHOM_MANY_RUNS();
  int named = 0;
  int all = 0;
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kDraws; ++seed) {
    sim::Random random(seed, "mistakes");
    for (const Drawn& mistake : mistakes(random)) {
      const PlausibilityRun run(seed, mistake.change);
      ++all;
      const std::string& expected = *mistake.names.begin();
      if (run.named.empty()) continue;
      ++named;
      EXPECT_TRUE(mistake.names.contains(run.named)) << expected << " seed " << seed << ": " << run.advice;
      EXPECT_NE(run.phase, AlignmentPhase::aligned) << expected << " seed " << seed;
    }
  }
  EXPECT_GE(named, 0.9 * all) << named << " of " << all;
}

TEST(PlausibilityDrawn, InstrumentsAsBadAsTheirSheetsAllowAreLeftAlone) {
  FATHOM_MANY_RUNS();
  for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + 4 * kDraws; ++seed) {
    sim::Random random(seed, "sheets");
    const double deviation = random.normal(3.0 * kRadPerDeg);
    const double turned = random.normal(2.0 * kRadPerDeg);
    const double scale = 1.0 + random.normal(0.02);
    const double slow = random.uniform(0.98, 1.02);
    const PlausibilityRun run(seed, [&](sim::Measurement& measurement) {
      change_of<HeadingSample>(
          [&](HeadingSample& s) { s.heading_rad += deviation * std::sin(s.heading_rad); })(measurement);
      change_of<DvlSample>([&](DvlSample& s) {
        const double x = s.velocity_D_m_s[0];
        s.velocity_D_m_s[0] = scale * (x - turned * s.velocity_D_m_s[1]);
        s.velocity_D_m_s[1] = scale * (s.velocity_D_m_s[1] + turned * x);
      })(measurement);
      change_of<ImuSample>([&](ImuSample& s) {
        s.header.stamp_ns =
            kDriveEpoch_ns +
            static_cast<TimeNs>(slow * static_cast<double>(s.header.stamp_ns - kDriveEpoch_ns));
      })(measurement);
    });
    EXPECT_EQ(run.named, "") << "seed " << seed << ": " << run.advice;
  }
}

}  // namespace
}  // namespace fathom::estimation

// What the simulator's encoder of Septentrio receivers writes, the codec reads back within the resolution of
// the format.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "codec/satellite/sbf/sbf.hpp"
#include "receiver_round_trip.hpp"
#include "sim/encode/sbf.hpp"

namespace fathom {
namespace {

using test::expect_same3;
using test::kRuns;
using test::kSomeTime_ns;
using test::read;

class SbfRoundTrip : public test::ReceiverRoundTrip {
 protected:
  GpsSample draw_solution(int run) {
    constexpr std::array<GpsFix, 7> kFixes{GpsFix::none,     GpsFix::dead_reckoning, GpsFix::fix_2d,
                                           GpsFix::fix_3d,   GpsFix::differential,   GpsFix::rtk_float,
                                           GpsFix::rtk_fixed};
    GpsSample s =
        draw_fix(kFixes[static_cast<std::size_t>(run) % kFixes.size()], run % 9 == 0 ? -1 : run % 40);
    if (s.fix == GpsFix::fix_2d) s.altitude_m = s.altitude_msl_m = s.position_sigma_N_m[2] = kUnknown;
    return s;
  }

  static void expect_same(const GpsSample& a, const GpsSample& b) {
    EXPECT_EQ(a.fix, b.fix);
    EXPECT_EQ(a.satellites, b.satellites);
    ASSERT_EQ(known(a.latitude_rad), known(b.latitude_rad));
    ASSERT_EQ(known(a.altitude_m), known(b.altitude_m));
    ASSERT_EQ(known(a.velocity_N_m_s[0]), known(b.velocity_N_m_s[0]));
    ASSERT_EQ(known(a.course_rad), known(b.course_rad));
    if (known(a.latitude_rad)) {
      EXPECT_EQ(a.latitude_rad, b.latitude_rad);
      EXPECT_EQ(a.longitude_rad, b.longitude_rad);
    }
    if (known(a.altitude_m)) {
      EXPECT_EQ(a.altitude_m, b.altitude_m);
      EXPECT_NEAR(a.altitude_msl_m, b.altitude_msl_m, 1e-5);
    }
    if (known(a.velocity_N_m_s[0])) {
      expect_same3(a.velocity_N_m_s, b.velocity_N_m_s, kSingle, 0.0);
      EXPECT_NEAR(a.course_rad, b.course_rad, 1e-6);
    }
  }

  static void expect_same_sigma(double a, double b, double relative) {
    ASSERT_EQ(known(a), known(b));
    if (known(a)) {
      EXPECT_NEAR(a, b, relative * a);
    }
  }
};

TEST_F(SbfRoundTrip, KeepsPositionVelocityAndTheirSigmas) {
  for (int run = 0; run < kRuns; ++run) {
    const GpsSample s = draw_solution(run);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    // As soon as it is known that covariances follow; before, and where there are none, HAccuracy counts.
    auto bytes = sim::encode::sbf_epoch(draw_solution(run), utc_ns - kNsPerSecond);
    const auto epoch = sim::encode::sbf_epoch(s, utc_ns);
    bytes.insert(bytes.end(), epoch.begin(), epoch.end());
    const auto got = read(codec::make_sbf({}), bytes);
    ASSERT_EQ(got.size(), 2U);
    const auto& r = std::get<GpsSample>(got[1].sample);
    expect_same(s, r);
    for (std::size_t i = 0; i < 3; ++i) {
      expect_same_sigma(s.position_sigma_N_m[i], r.position_sigma_N_m[i], kSingle);
      expect_same_sigma(s.velocity_sigma_N_m_s[i], r.velocity_sigma_N_m_s[i], kSingle);
    }
    EXPECT_EQ(got[1].time.utc_ns, utc_ns / kNsPerMillisecond * kNsPerMillisecond);
    EXPECT_FALSE(got[1].time.clock_ns.has_value());
  }
}

TEST_F(SbfRoundTrip, WithoutCovariancesTheAccuraciesCount) {
  for (int run = 0; run < kRuns; ++run) {
    const GpsSample s = draw_solution(run);
    const auto got = read(codec::make_sbf({}), sim::encode::sbf_pvt_geodetic(s, kSomeTime_ns));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<GpsSample>(got[0].sample);
    expect_same(s, r);
    EXPECT_FALSE(known(r.velocity_sigma_N_m_s[0]));
    if (s.fix == GpsFix::none) continue;
    const double horizontal_m = std::hypot(s.position_sigma_N_m[0], s.position_sigma_N_m[1]);
    EXPECT_NEAR(std::hypot(r.position_sigma_N_m[0], r.position_sigma_N_m[1]), horizontal_m, 0.003);
    ASSERT_EQ(known(r.position_sigma_N_m[2]), s.fix != GpsFix::fix_2d);
    if (s.fix != GpsFix::fix_2d) {
      EXPECT_NEAR(r.position_sigma_N_m[2], s.position_sigma_N_m[2], 0.003);
    }
  }
}

TEST_F(SbfRoundTrip, KeepsTheHeadingOfTwoAntennas) {
  for (int run = 0; run < kRuns; ++run) {
    const HeadingSample s = draw_heading(run);
    const HeadingSample sent = of_either_north(s);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    auto bytes = sim::encode::sbf_attitude_epoch(sent, utc_ns - kNsPerSecond);
    const auto epoch = sim::encode::sbf_attitude_epoch(sent, utc_ns);
    bytes.insert(bytes.end(), epoch.begin(), epoch.end());
    const auto got = read(codec::make_sbf({}), bytes);
    ASSERT_EQ(got.size(), 2U);
    expect_same_heading(s, std::get<HeadingSample>(got[1].sample), 1e-6, 2.0 * kSingle * s.sigma_rad);
    EXPECT_EQ(got[1].time.utc_ns, utc_ns / kNsPerMillisecond * kNsPerMillisecond);
  }
}

TEST_F(SbfRoundTrip, TheLeapSecondsOfTheReceiverCount) {
  auto bytes = sim::encode::sbf_receiver_time(kSomeTime_ns, 17);
  const auto block = sim::encode::sbf_pvt_geodetic({}, kSomeTime_ns);
  bytes.insert(bytes.end(), block.begin(), block.end());
  const auto got = read(codec::make_sbf({}), bytes);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].time.utc_ns, kSomeTime_ns / kNsPerMillisecond * kNsPerMillisecond + kNsPerSecond);
}

}  // namespace
}  // namespace fathom

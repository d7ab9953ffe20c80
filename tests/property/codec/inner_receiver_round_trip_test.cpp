// What the simulator's encoders of receivers inside inertial units write, the codecs read back within the
// protocol's resolution.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "codec/imu/microstrain.hpp"
#include "codec/imu/sbg.hpp"
#include "codec/satellite/ubx.hpp"
#include "receiver_round_trip.hpp"
#include "sim/encode/imu/microstrain.hpp"
#include "sim/encode/imu/sbg.hpp"
#include "sim/encode/ubx.hpp"

namespace fathom {
namespace {

using test::expect_same3;
using test::kRuns;
using test::kSomeTime_ns;
using test::read;

class InnerReceiverRoundTrip : public test::ReceiverRoundTrip {
 protected:
  /// One accuracy for both horizontal axes, and one for the velocity.
  GpsSample draw_solution(int run) {
    constexpr std::array<GpsFix, 6> kFixes{GpsFix::none,         GpsFix::fix_3d,    GpsFix::fix_3d,
                                           GpsFix::differential, GpsFix::rtk_float, GpsFix::rtk_fixed};
    GpsSample s =
        draw_fix(kFixes[static_cast<std::size_t>(run) % kFixes.size()], run % 7 == 0 ? -1 : run % 40);
    s.position_sigma_N_m[1] = s.position_sigma_N_m[0];
    s.velocity_sigma_N_m_s.fill(s.velocity_sigma_N_m_s[0]);
    return s;
  }

  static void expect_same(const GpsSample& a, const GpsSample& b) {
    EXPECT_EQ(a.fix, b.fix);
    EXPECT_EQ(a.satellites, b.satellites);
    ASSERT_EQ(known(a.latitude_rad), known(b.latitude_rad));
    ASSERT_EQ(known(a.velocity_N_m_s[0]), known(b.velocity_N_m_s[0]));
    if (known(a.latitude_rad)) {
      EXPECT_NEAR(a.latitude_rad, b.latitude_rad, 1e-15);
      EXPECT_NEAR(a.longitude_rad, b.longitude_rad, 2e-15);
      EXPECT_NEAR(a.altitude_m, b.altitude_m, 1e-5);
      EXPECT_NEAR(a.altitude_msl_m, b.altitude_msl_m, 1e-9);
      expect_same3(a.position_sigma_N_m, b.position_sigma_N_m, kSingle, 0.0);
    }
    if (known(a.velocity_N_m_s[0])) {
      expect_same3(a.velocity_N_m_s, b.velocity_N_m_s, kSingle, 0.0);
      expect_same3(a.velocity_sigma_N_m_s, b.velocity_sigma_N_m_s, kSingle, 0.0);
      EXPECT_NEAR(a.course_rad, b.course_rad, 1e-6);
    }
  }
};

TEST_F(InnerReceiverRoundTrip, MicroStrainKeepsDoublesOfThePosition) {
  for (int run = 0; run < kRuns; ++run) {
    GpsSample s = draw_solution(run);
    if (s.fix != GpsFix::none && chance(0.5)) s.hdop = draw(0.5, 20.0);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    const auto got = read(codec::make_microstrain({}), sim::encode::microstrain_gnss(s, utc_ns, 0x91));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<GpsSample>(got[0].sample);
    expect_same(s, r);
    EXPECT_EQ(known(s.hdop), known(r.hdop));
    ASSERT_TRUE(got[0].time.utc_ns.has_value());
    EXPECT_NEAR(static_cast<double>(*got[0].time.utc_ns - utc_ns), 0.0,
                1e3);  // seconds of a week as a double
    EXPECT_FALSE(got[0].time.clock_ns.has_value());
  }
}

TEST_F(InnerReceiverRoundTrip, SbgKeepsMillisecondsAndDoublesOfThePosition) {
  constexpr std::array<GpsJamming, 4> kJamming{GpsJamming::unknown, GpsJamming::none, GpsJamming::warning,
                                               GpsJamming::critical};
  for (int run = 0; run < kRuns; ++run) {
    GpsSample s = draw_solution(run);
    s.jamming = kJamming[static_cast<std::size_t>(run) % 4];
    s.spoofing = run % 3 == 0 ? GpsSpoofing::affirmed : GpsSpoofing::none;
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    const auto since_startup_ns = static_cast<DurationNs>(draw(0.0, 4e12));
    const auto got = read(codec::make_sbg({}), sim::encode::sbg_epoch(s, utc_ns, since_startup_ns));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<GpsSample>(got[0].sample);
    expect_same(s, r);
    EXPECT_EQ(s.jamming, r.jamming);
    EXPECT_EQ(s.spoofing, r.spoofing);
    EXPECT_EQ(got[0].time.clock_ns, since_startup_ns / 1'000 * 1'000);
    ASSERT_EQ(got[0].time.utc_ns.has_value(), s.fix != GpsFix::none);
    if (got[0].time.utc_ns) {
      EXPECT_EQ(*got[0].time.utc_ns, utc_ns / 1'000'000 * 1'000'000);
    }
  }
}

TEST_F(InnerReceiverRoundTrip, SbgKeepsTheHeadingOfTwoAntennas) {
  for (int run = 0; run < kRuns; ++run) {
    const HeadingSample s = draw_heading(run);
    const HeadingSample sent = of_either_north(s);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    const auto since_startup_ns = static_cast<DurationNs>(draw(0.0, 4e12));
    auto bytes = sim::encode::sbg_utc_time(utc_ns, since_startup_ns);
    const auto log = sim::encode::sbg_gps_heading(sent, utc_ns, since_startup_ns);
    bytes.insert(bytes.end(), log.begin(), log.end());
    const auto got = read(codec::make_sbg({}), bytes);
    ASSERT_EQ(got.size(), 1U);
    expect_same_heading(s, std::get<HeadingSample>(got[0].sample), 1e-6, kSingle * s.sigma_rad);
    EXPECT_EQ(got[0].time.clock_ns, since_startup_ns / 1'000 * 1'000);
    ASSERT_EQ(got[0].time.utc_ns.has_value(), known(s.heading_rad));
    if (got[0].time.utc_ns) {
      EXPECT_EQ(*got[0].time.utc_ns, utc_ns / 1'000'000 * 1'000'000);
    }
  }
}

TEST_F(InnerReceiverRoundTrip, UbxKeepsTheHeadingOfAMovingBase) {
  for (int run = 0; run < kRuns; ++run) {
    const HeadingSample sent = draw_heading(run);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    auto bytes = sim::encode::ubx_nav_pvt({}, utc_ns);
    const auto message = sim::encode::ubx_nav_relposned(sent, utc_ns);
    bytes.insert(bytes.end(), message.begin(), message.end());
    const auto got = read(codec::make_ubx({}), bytes);
    ASSERT_EQ(got.size(), 2U) << "the solution, and the heading";
    expect_same_heading(sent, std::get<HeadingSample>(got[1].sample), 1e-7, 1e-7);
    ASSERT_TRUE(got[1].time.utc_ns);
    EXPECT_NEAR(static_cast<double>(*got[1].time.utc_ns - utc_ns), 0.0, 1e6) << "whole milliseconds";
  }
}

}  // namespace
}  // namespace fathom

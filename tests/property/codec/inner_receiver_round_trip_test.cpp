// What the simulator's encoders of receivers inside inertial units write, the codecs read back within the
// protocol's resolution.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "codec/imu/microstrain.hpp"
#include "codec/imu/sbg.hpp"
#include "codec/satellite/ubx.hpp"
#include "round_trip.hpp"
#include "sim/encode/imu/microstrain.hpp"
#include "sim/encode/imu/sbg.hpp"
#include "sim/encode/ubx.hpp"

namespace fathom {
namespace {

using test::expect_same3;
using test::kRuns;
using test::kSomeTime_ns;
using test::read;

constexpr double kSingle = 6e-8;

class InnerReceiverRoundTrip : public test::RoundTrip {
 protected:
  GpsSample draw_fix(int run) {
    constexpr std::array<GpsFix, 6> kFixes{GpsFix::none,         GpsFix::fix_3d,    GpsFix::fix_3d,
                                           GpsFix::differential, GpsFix::rtk_float, GpsFix::rtk_fixed};
    GpsSample s;
    s.fix = kFixes[static_cast<std::size_t>(run) % kFixes.size()];
    s.satellites = run % 7 == 0 ? -1 : run % 40;
    if (s.fix == GpsFix::none) return s;
    s.latitude_rad = draw(-1.57, 1.57);
    s.longitude_rad = draw(-3.14, 3.14);
    s.altitude_m = draw(-100.0, 9'000.0);
    s.altitude_msl_m = s.altitude_m - draw(-100.0, 80.0);
    const double horizontal_m = draw(0.01, 30.0);
    s.position_sigma_N_m = {horizontal_m, horizontal_m, draw(0.01, 60.0)};
    if (chance(0.8)) {
      s.velocity_N_m_s = draw3(60.0);
      s.velocity_sigma_N_m_s.fill(draw(0.01, 3.0));
      s.course_rad = draw(0.0, 2.0 * std::numbers::pi);
    }
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
    GpsSample s = draw_fix(run);
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
    GpsSample s = draw_fix(run);
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
    HeadingSample s;
    if (run % 5 != 0) s.heading_rad = draw(0.0, 2.0 * std::numbers::pi);
    if (known(s.heading_rad) && chance(0.7)) s.sigma_rad = draw(0.0005, 3.0);
    HeadingSample sent = s;
    if (chance(0.3)) {
      sent.north = North::magnetic;
      sent.variation_rad = draw(-0.4, 0.4);
      sent.heading_rad -= sent.variation_rad;
    }
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    const auto since_startup_ns = static_cast<DurationNs>(draw(0.0, 4e12));
    auto bytes = sim::encode::sbg_utc_time(utc_ns, since_startup_ns);
    const auto log = sim::encode::sbg_gps_heading(sent, utc_ns, since_startup_ns);
    bytes.insert(bytes.end(), log.begin(), log.end());
    const auto got = read(codec::make_sbg({}), bytes);
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<HeadingSample>(got[0].sample);
    EXPECT_EQ(r.north, North::true_north);
    ASSERT_EQ(known(r.heading_rad), known(s.heading_rad));
    ASSERT_EQ(known(r.sigma_rad), known(s.sigma_rad));
    EXPECT_EQ(got[0].time.clock_ns, since_startup_ns / 1'000 * 1'000);
    ASSERT_EQ(got[0].time.utc_ns.has_value(), known(s.heading_rad));
    if (!known(s.heading_rad)) continue;
    EXPECT_GE(r.heading_rad, 0.0);
    EXPECT_LT(r.heading_rad, 2.0 * std::numbers::pi);
    EXPECT_NEAR(std::remainder(r.heading_rad - s.heading_rad, 2.0 * std::numbers::pi), 0.0, 1e-6);
    if (known(s.sigma_rad)) {
      EXPECT_NEAR(r.sigma_rad, s.sigma_rad, kSingle * s.sigma_rad);
    }
    EXPECT_EQ(*got[0].time.utc_ns, utc_ns / 1'000'000 * 1'000'000);
  }
}

TEST_F(InnerReceiverRoundTrip, UbxKeepsTheHeadingOfAMovingBase) {
  for (int run = 0; run < kRuns; ++run) {
    HeadingSample sent;
    if (run % 5 != 0) sent.heading_rad = draw(0.0, 2.0 * std::numbers::pi);
    if (known(sent.heading_rad) && chance(0.7)) sent.sigma_rad = draw(0.0005, 3.0);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    auto bytes = sim::encode::ubx_nav_pvt({}, utc_ns);
    const auto message = sim::encode::ubx_nav_relposned(sent, utc_ns);
    bytes.insert(bytes.end(), message.begin(), message.end());
    const auto got = read(codec::make_ubx({}), bytes);
    ASSERT_EQ(got.size(), 2U) << "the solution, and the heading";
    const auto& r = std::get<HeadingSample>(got[1].sample);
    ASSERT_EQ(known(r.heading_rad), known(sent.heading_rad));
    ASSERT_EQ(known(r.sigma_rad), known(sent.sigma_rad));
    ASSERT_TRUE(got[1].time.utc_ns);
    EXPECT_NEAR(static_cast<double>(*got[1].time.utc_ns - utc_ns), 0.0, 1e6) << "whole milliseconds";
    if (!known(sent.heading_rad)) continue;
    EXPECT_LT(r.heading_rad, 2.0 * std::numbers::pi);
    EXPECT_NEAR(std::remainder(r.heading_rad - sent.heading_rad, 2.0 * std::numbers::pi), 0.0, 1e-7);
    if (known(sent.sigma_rad)) {
      EXPECT_NEAR(r.sigma_rad, sent.sigma_rad, 1e-7);
    }
  }
}

}  // namespace
}  // namespace fathom

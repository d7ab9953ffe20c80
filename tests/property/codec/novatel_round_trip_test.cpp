// What the simulator's encoder of a NovAtel receiver writes, its codec reads back within the logs'
// resolution.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "codec/satellite/novatel/novatel.hpp"
#include "receiver_round_trip.hpp"
#include "sim/encode/novatel.hpp"

namespace fathom {
namespace {

using test::expect_same3;
using test::kRuns;
using test::kSomeTime_ns;

class NovatelRoundTrip : public test::ReceiverRoundTrip {
 protected:
  GpsSample draw_solution(int run) {
    constexpr std::array<GpsFix, 7> kFixes{GpsFix::none,     GpsFix::dead_reckoning, GpsFix::fix_2d,
                                           GpsFix::fix_3d,   GpsFix::differential,   GpsFix::rtk_float,
                                           GpsFix::rtk_fixed};
    return draw_fix(kFixes[static_cast<std::size_t>(run) % kFixes.size()], run % 40);
  }
};

TEST_F(NovatelRoundTrip, KeepsDoublesOfPositionAndVelocity) {
  for (int run = 0; run < kRuns; ++run) {
    const GpsSample s = draw_solution(run);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    const auto got = test::read(codec::make_novatel({}), sim::encode::novatel_epoch(s, utc_ns));
    ASSERT_EQ(got.size(), 1U);
    EXPECT_EQ(got[0].time.utc_ns, utc_ns / 1'000'000 * 1'000'000);
    EXPECT_FALSE(got[0].time.clock_ns.has_value());
    const auto& r = std::get<GpsSample>(got[0].sample);
    EXPECT_EQ(r.fix, s.fix);
    EXPECT_EQ(r.satellites, s.satellites);
    ASSERT_EQ(known(r.latitude_rad), known(s.latitude_rad));
    ASSERT_EQ(known(r.velocity_N_m_s[0]), known(s.velocity_N_m_s[0]));
    EXPECT_FALSE(known(r.velocity_sigma_N_m_s[0])) << "BESTVEL has no accuracy";
    if (known(s.latitude_rad)) {
      EXPECT_NEAR(r.latitude_rad, s.latitude_rad, 1e-15);
      EXPECT_NEAR(r.longitude_rad, s.longitude_rad, 2e-15);
      EXPECT_NEAR(r.altitude_m, s.altitude_m, 1e-5);
      EXPECT_NEAR(r.altitude_msl_m, s.altitude_msl_m, 1e-9);
      expect_same3(s.position_sigma_N_m, r.position_sigma_N_m, kSingle, 0.0);
    }
    if (known(s.velocity_N_m_s[0])) {
      expect_same3(s.velocity_N_m_s, r.velocity_N_m_s, 0.0, 1e-12);
      const double course_rad = std::atan2(s.velocity_N_m_s[1], s.velocity_N_m_s[0]);
      EXPECT_NEAR(std::remainder(r.course_rad - course_rad, kTurn_rad), 0.0, 1e-12);
    }
  }
}

TEST_F(NovatelRoundTrip, KeepsTheHeadingOfTwoAntennas) {
  using sim::encode::NovatelHeadingLog;
  for (int run = 0; run < kRuns; ++run) {
    const HeadingSample s = draw_heading(run);
    const HeadingSample sent = of_either_north(s);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    const auto log = run % 2 == 0 ? NovatelHeadingLog::heading2 : NovatelHeadingLog::dual_antenna;
    const auto got = test::read(codec::make_novatel({}), sim::encode::novatel_heading(sent, utc_ns, log));
    ASSERT_EQ(got.size(), 1U);
    EXPECT_EQ(got[0].time.utc_ns, utc_ns / 1'000'000 * 1'000'000);
    expect_same_heading(s, std::get<HeadingSample>(got[0].sample), 1e-6, kSingle * s.sigma_rad);
  }
}

}  // namespace
}  // namespace fathom

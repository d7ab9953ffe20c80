// What the simulator's encoders of DVLs write, the codecs read back within the protocol's resolution.
#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/dvl/nortek.hpp"
#include "codec/dvl/pd0.hpp"
#include "codec/dvl/pd0_geometry.hpp"
#include "codec/dvl/pd6.hpp"
#include "codec/dvl/waterlinked.hpp"
#include "round_trip.hpp"
#include "sim/encode/dvl/nortek.hpp"
#include "sim/encode/dvl/pd0.hpp"
#include "sim/encode/dvl/pd6.hpp"
#include "sim/encode/dvl/waterlinked.hpp"

namespace fathom {
namespace {

using test::expect_same3;
using test::kRuns;
using test::kSomeTime_ns;
using test::read;

class DvlRoundTrip : public test::RoundTrip {};

TEST_F(DvlRoundTrip, Pd0InEveryFrame) {
  for (const DvlFrame frame : {DvlFrame::beam, DvlFrame::instrument, DvlFrame::ship, DvlFrame::earth}) {
    for (int run = 0; run < kRuns; ++run) {
      const DvlSample s = draw_dvl(frame);
      sim::encode::Pd0Options options;
      options.high_resolution = chance(0.5);
      options.ensemble = static_cast<std::uint32_t>(run) * 1'000U;
      options.heading_alignment_rad = chance(0.5) ? 45.0 * kRadPerDeg : 0.0;
      codec::CodecOptions reading;
      reading.dvl_heading_alignment_rad = options.heading_alignment_rad;
      const TimeNs clock_ns = kSomeTime_ns + run * 123'456'789LL;

      const auto got = read(codec::make_pd0(reading), sim::encode::pd0(s, clock_ns, options));
      ASSERT_EQ(got.size(), 1U);
      const auto& r = std::get<DvlSample>(got[0].sample);
      EXPECT_EQ(r.mode, DvlMode::bottom);
      EXPECT_EQ(r.recorded_frame, frame);
      ASSERT_TRUE(got[0].time.clock_ns.has_value());
      EXPECT_LE(std::abs(*got[0].time.clock_ns - clock_ns), 5 * kNsPerMillisecond);
      // Half a unit of the number sent, spread over axes by the Janus transformation at most twofold.
      const double unit = options.high_resolution ? 1e-5 : 1e-3;
      expect_same3(s.velocity_D_m_s, r.velocity_D_m_s, 0.0, 1.6 * unit);
      if (frame != DvlFrame::beam) {
        EXPECT_NEAR(r.error_velocity_m_s, s.error_velocity_m_s, 0.51 * unit);
      } else {
        EXPECT_NEAR(r.error_velocity_m_s, 0.0, 4.0 * unit);
      }
      EXPECT_NEAR(r.altitude_m, s.altitude_m, 0.0051);
      EXPECT_NEAR(r.heading_rad, s.heading_rad, 1e-9);
      EXPECT_NEAR(r.pitch_rad, s.pitch_rad, 1e-9);
      EXPECT_NEAR(r.roll_rad, s.roll_rad, 1e-9);
      EXPECT_DOUBLE_EQ(r.sound_speed_m_s, s.sound_speed_m_s);
      EXPECT_NEAR(r.beam_angle_rad, s.beam_angle_rad, 1e-12);
    }
  }
}

TEST_F(DvlRoundTrip, Pd0BeamsAreTheVelocityAlongThem) {
  for (int run = 0; run < kRuns; ++run) {
    const DvlSample s = draw_dvl(DvlFrame::beam);
    const auto got = read(codec::make_pd0({}), sim::encode::pd0(s, kSomeTime_ns));
    ASSERT_EQ(got.size(), 1U);
    const auto expected = codec::pd0::beams_from_frd(s.velocity_D_m_s, s.beam_angle_rad);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(std::get<DvlSample>(got[0].sample).beam_velocity_m_s[i], expected[i], 1e-5);
    }
  }
}

TEST_F(DvlRoundTrip, Pd0WithAnyOneBeamLostKeepsTheVelocity) {
  for (int run = 0; run < kRuns; ++run) {
    DvlSample s = draw_dvl(DvlFrame::beam);
    s.beam_velocity_m_s = codec::pd0::beams_from_frd(s.velocity_D_m_s, s.beam_angle_rad);
    const std::size_t lost = static_cast<std::size_t>(run) % 4;
    s.beam_velocity_m_s[lost] = kUnknown;
    s.beam_range_m[lost] = kUnknown;
    const auto got = read(codec::make_pd0({}), sim::encode::pd0(s, kSomeTime_ns));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<DvlSample>(got[0].sample);
    expect_same3(s.velocity_D_m_s, r.velocity_D_m_s, 0.0, 5e-5);
    EXPECT_FALSE(known(r.error_velocity_m_s));
    EXPECT_FALSE(known(r.beam_velocity_m_s[lost]));
    EXPECT_FALSE(known(r.beam_range_m[lost]));
  }
}

TEST_F(DvlRoundTrip, Pd0WithWaterLayerAndLostBottom) {
  for (int run = 0; run < kRuns; ++run) {
    DvlSample bottom = draw_dvl(DvlFrame::instrument);
    DvlSample water = bottom;
    water.mode = DvlMode::water;
    water.velocity_D_m_s = draw3(2.0);
    const bool lost = chance(0.5);
    if (lost) {
      bottom.velocity_D_m_s.fill(kUnknown);
      bottom.error_velocity_m_s = kUnknown;
      bottom.beam_range_m.fill(kUnknown);
      bottom.altitude_m = kUnknown;
    }
    const auto got = read(codec::make_pd0({}), sim::encode::pd0(bottom, kSomeTime_ns, {}, &water));
    ASSERT_EQ(got.size(), 2U);
    const auto& b = std::get<DvlSample>(got[0].sample);
    const auto& w = std::get<DvlSample>(got[1].sample);
    EXPECT_EQ(b.mode, DvlMode::bottom);
    EXPECT_EQ(known(b.velocity_D_m_s[0]), !lost);
    EXPECT_EQ(known(b.altitude_m), !lost);
    EXPECT_EQ(w.mode, DvlMode::water);
    expect_same3(water.velocity_D_m_s, w.velocity_D_m_s, 0.0, 1e-5);
    EXPECT_EQ(got[0].offset, got[1].offset);
  }
}

TEST_F(DvlRoundTrip, Pd6InEveryFrame) {
  for (const DvlFrame frame : {DvlFrame::instrument, DvlFrame::ship, DvlFrame::earth}) {
    for (int run = 0; run < kRuns; ++run) {
      DvlSample s = draw_dvl(frame);
      if (chance(0.2)) s.error_velocity_m_s = kUnknown;
      DvlSample w = s;
      w.velocity_D_m_s = draw3(2.0);
      const bool lost = chance(0.2);
      if (lost) {
        s.velocity_D_m_s.fill(kUnknown);
        s.altitude_m = kUnknown;
      }
      const bool water = chance(0.5);
      codec::CodecOptions reading;
      reading.dvl_heading_alignment_rad = chance(0.5) ? 45.0 * kRadPerDeg : 0.0;
      const TimeNs clock_ns = kSomeTime_ns + run * 123'456'789LL;

      const auto got =
          read(codec::make_pd6(reading),
               sim::encode::pd6(s, clock_ns, reading.dvl_heading_alignment_rad, water ? &w : nullptr));
      ASSERT_EQ(got.size(), water ? 2U : 1U);
      const auto& r = std::get<DvlSample>(got[0].sample);
      EXPECT_EQ(r.mode, DvlMode::bottom);
      EXPECT_EQ(r.recorded_frame, frame);
      ASSERT_TRUE(got[0].time.clock_ns.has_value());
      EXPECT_LE(std::abs(*got[0].time.clock_ns - clock_ns), 5 * kNsPerMillisecond);
      EXPECT_EQ(known(r.velocity_D_m_s[0]), !lost);
      EXPECT_EQ(known(r.altitude_m), !lost);
      // Half a millimetre a second along each axis that was sent.
      constexpr double kRounding_m_s = 0.9e-3;
      if (!lost) {
        expect_same3(s.velocity_D_m_s, r.velocity_D_m_s, 0.0, kRounding_m_s);
        EXPECT_NEAR(r.altitude_m, s.altitude_m, 0.0051);
        const bool sent = frame == DvlFrame::instrument && known(s.error_velocity_m_s);
        ASSERT_EQ(known(r.error_velocity_m_s), sent);
        if (sent) {
          EXPECT_NEAR(r.error_velocity_m_s, s.error_velocity_m_s, 0.51e-3);
        }
      }
      EXPECT_NEAR(r.heading_rad, s.heading_rad, 1e-9);
      EXPECT_NEAR(r.pitch_rad, s.pitch_rad, 1e-9);
      EXPECT_NEAR(r.roll_rad, s.roll_rad, 1e-9);
      EXPECT_DOUBLE_EQ(r.sound_speed_m_s, s.sound_speed_m_s);
      if (!water) continue;
      const auto& through = std::get<DvlSample>(got[1].sample);
      EXPECT_EQ(through.mode, DvlMode::water);
      expect_same3(w.velocity_D_m_s, through.velocity_D_m_s, 0.0, kRounding_m_s);
      EXPECT_EQ(got[0].offset, got[1].offset);
    }
  }
}

TEST_F(DvlRoundTrip, WaterLinkedKeepsEveryBit) {
  for (int run = 0; run < kRuns; ++run) {
    DvlSample s = draw_dvl(DvlFrame::instrument);
    s.mode = chance(0.8) ? DvlMode::bottom : DvlMode::water;
    s.sigma_m_s = draw(1e-4, 0.1);
    const bool valid = chance(0.8);
    if (valid) {
      for (std::size_t i = 0; i < 4; ++i) {
        s.beam_velocity_m_s[i] = chance(0.9) ? draw(-2.0, 2.0) : kUnknown;
      }
    } else {
      s.velocity_D_m_s.fill(kUnknown);
      s.altitude_m = kUnknown;
    }
    sim::encode::WaterLinkedTimes times;
    times.valid_ns = kSomeTime_ns / 1'000 * 1'000 + run * 1'000'000LL;
    times.sent_ns = times.valid_ns + 190'000'000;
    const auto got = read(codec::make_waterlinked({}), sim::encode::waterlinked(s, times));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<DvlSample>(got[0].sample);
    EXPECT_EQ(r.mode, s.mode);
    EXPECT_EQ(got[0].time.clock_ns, times.valid_ns);
    EXPECT_EQ(got[0].time.age_ns, 190'000'000);
    EXPECT_EQ(known(r.velocity_D_m_s[0]), valid);
    if (!valid) continue;
    EXPECT_EQ(r.velocity_D_m_s, s.velocity_D_m_s);
    EXPECT_NEAR(r.sigma_m_s, s.sigma_m_s, 1e-12);
    if (s.mode == DvlMode::water) continue;
    EXPECT_EQ(r.altitude_m, s.altitude_m);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(known(r.beam_velocity_m_s[i]), known(s.beam_velocity_m_s[i]));
      if (known(s.beam_velocity_m_s[i])) {
        EXPECT_EQ(r.beam_velocity_m_s[i], s.beam_velocity_m_s[i]);
      }
    }
  }
}

TEST_F(DvlRoundTrip, NortekKeepsSinglePrecision) {
  for (int run = 0; run < kRuns; ++run) {
    DvlSample s = draw_dvl(DvlFrame::instrument);
    s.mode = chance(0.8) ? DvlMode::bottom : DvlMode::water;
    if (chance(0.7)) s.sigma_m_s = draw(1e-4, 0.1);
    for (std::size_t i = 0; i < 4; ++i) {
      s.beam_velocity_m_s[i] = chance(0.9) ? draw(-2.0, 2.0) : kUnknown;
      if (chance(0.1)) s.beam_range_m[i] = kUnknown;
    }
    for (double& v : s.velocity_D_m_s) {
      if (chance(0.1)) v = kUnknown;
    }
    const bool three_beams = chance(0.2);
    if (three_beams) s.error_velocity_m_s = kUnknown;
    sim::encode::NortekTimes times;
    times.valid_ns = kSomeTime_ns + run * 123'456'789LL;
    times.sent_ns = times.valid_ns + static_cast<DurationNs>(draw(0.0, 9e8));
    const auto got = read(codec::make_nortek({}), sim::encode::nortek(s, times));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<DvlSample>(got[0].sample);
    EXPECT_EQ(r.mode, s.mode);
    ASSERT_TRUE(got[0].time.clock_ns && got[0].time.age_ns);
    EXPECT_LE(std::abs(*got[0].time.clock_ns - times.valid_ns), 2);
    EXPECT_LE(std::abs(*got[0].time.age_ns - (times.sent_ns - times.valid_ns)), 60);
    const auto expect_same = [](double sent, double read, double absolute) {
      EXPECT_EQ(known(read), known(sent));
      if (known(sent)) {
        EXPECT_NEAR(read, sent, 6e-8 * std::abs(sent) + absolute);
      }
    };
    for (std::size_t i = 0; i < 3; ++i) expect_same(s.velocity_D_m_s[i], r.velocity_D_m_s[i], 6e-9);
    expect_same(known(s.velocity_D_m_s[2]) ? s.error_velocity_m_s : kUnknown, r.error_velocity_m_s, 1e-6);
    const bool horizontal = known(s.velocity_D_m_s[0]) && known(s.velocity_D_m_s[1]);
    expect_same(horizontal ? s.sigma_m_s : kUnknown, r.sigma_m_s, 0.0);
    expect_same(s.sound_speed_m_s, r.sound_speed_m_s, 0.0);
    for (std::size_t i = 0; i < 4; ++i) {
      expect_same(s.beam_velocity_m_s[i], r.beam_velocity_m_s[i], 0.0);
      expect_same(s.mode == DvlMode::bottom ? s.beam_range_m[i] : kUnknown, r.beam_range_m[i], 0.0);
    }
  }
}

}  // namespace
}  // namespace fathom

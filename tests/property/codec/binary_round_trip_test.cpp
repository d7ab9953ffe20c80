// What the simulator's encoders write, the codecs read back within the protocol's resolution.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/dvl/nortek.hpp"
#include "codec/dvl/pd0.hpp"
#include "codec/dvl/pd0_geometry.hpp"
#include "codec/dvl/pd6.hpp"
#include "codec/dvl/waterlinked.hpp"
#include "codec/imu/microstrain.hpp"
#include "codec/imu/stim300.hpp"
#include "codec/imu/vectornav.hpp"
#include "codec/imu/xsens.hpp"
#include "sim/encode/microstrain.hpp"
#include "sim/encode/nortek.hpp"
#include "sim/encode/pd0.hpp"
#include "sim/encode/pd6.hpp"
#include "sim/encode/stim300.hpp"
#include "sim/encode/vectornav.hpp"
#include "sim/encode/waterlinked.hpp"
#include "sim/encode/xsens.hpp"

namespace fathom {
namespace {

constexpr TimeNs kSomeTime_ns = 1'780'000'000'123'456'789;
constexpr int kRuns = 300;

class Collector : public codec::Sink {
 public:
  void on_sample(const codec::Decoded& decoded) override { samples.push_back(decoded); }
  void on_rejected(const codec::Rejected& rejected) override { rejects.push_back(rejected); }
  std::vector<codec::Decoded> samples;
  std::vector<codec::Rejected> rejects;
};

template <class Container>
std::vector<codec::Decoded> read(std::unique_ptr<codec::Codec> codec, const Container& bytes) {
  Collector sink;
  codec->feed({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, sink);
  codec->finish(sink);
  EXPECT_TRUE(sink.rejects.empty());
  EXPECT_EQ(codec->totals().skipped_bytes, 0U);
  return sink.samples;
}

class RoundTrip : public ::testing::Test {
 protected:
  double draw(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  std::array<double, 3> draw3(double limit) {
    return {draw(-limit, limit), draw(-limit, limit), draw(-limit, limit)};
  }
  bool chance(double p) { return draw(0.0, 1.0) < p; }

  DvlSample draw_dvl(DvlFrame frame) {
    DvlSample s;
    s.recorded_frame = frame;
    s.velocity_D_m_s = draw3(5.0);
    s.error_velocity_m_s = draw(-0.1, 0.1);
    s.beam_angle_rad = (chance(0.5) ? 20.0 : 30.0) * kRadPerDeg;
    s.altitude_m = draw(0.5, 900.0);
    s.beam_range_m.fill(s.altitude_m);
    s.sound_speed_m_s = std::floor(draw(1400.0, 1600.0));
    // What the leader can carry, so that turning back uses the same angles.
    s.heading_rad = std::floor(draw(0.0, 35'999.0)) * 0.01 * kRadPerDeg;
    s.pitch_rad = std::floor(draw(-4'000.0, 4'000.0)) * 0.01 * kRadPerDeg;
    s.roll_rad = std::floor(draw(-4'000.0, 4'000.0)) * 0.01 * kRadPerDeg;
    return s;
  }

 private:
  std::mt19937 random_{20'260'101};
};

void expect_same3(const std::array<double, 3>& a, const std::array<double, 3>& b, double relative,
                  double absolute) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], relative * std::abs(a[i]) + absolute);
}

TEST_F(RoundTrip, VectorNavKeepsNanosecondsAndSinglePrecision) {
  for (int run = 0; run < kRuns; ++run) {
    ImuSample s;
    s.angular_rate_B_rad_s = draw3(3.0);
    s.specific_force_B_m_s2 = draw3(30.0);
    const bool increments = chance(0.7);
    if (increments) {
      s.delta_time_s = 0.01;
      s.delta_angle_B_rad = draw3(0.03);
      s.delta_velocity_B_m_s = draw3(0.3);
    }
    if (chance(0.5)) s.temperature_degC = draw(-10.0, 60.0);
    const DurationNs since_startup_ns = static_cast<DurationNs>(draw(0.0, 4e15));
    const bool utc = chance(0.5);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;

    const auto frame =
        sim::encode::vectornav(s, since_startup_ns, utc ? std::optional(utc_ns) : std::nullopt);
    const auto got = read(codec::make_vectornav({}), frame);
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<ImuSample>(got[0].sample);
    EXPECT_EQ(got[0].time.clock_ns, since_startup_ns);
    EXPECT_EQ(got[0].time.utc_ns, utc ? std::optional(utc_ns) : std::nullopt);
    expect_same3(s.angular_rate_B_rad_s, r.angular_rate_B_rad_s, 6e-8, 0.0);
    expect_same3(s.specific_force_B_m_s2, r.specific_force_B_m_s2, 6e-8, 0.0);
    EXPECT_EQ(known(r.delta_time_s), increments);
    if (increments) {
      EXPECT_NEAR(r.delta_time_s, 0.01, 1e-9);
      expect_same3(s.delta_angle_B_rad, r.delta_angle_B_rad, 2e-7, 0.0);
      expect_same3(s.delta_velocity_B_m_s, r.delta_velocity_B_m_s, 6e-8, 0.0);
    }
    EXPECT_EQ(known(r.temperature_degC), known(s.temperature_degC));
  }
}

TEST_F(RoundTrip, XsensKeepsTicksAndSinglePrecision) {
  for (int run = 0; run < kRuns; ++run) {
    const std::int64_t ticks = static_cast<std::int64_t>(draw(0.0, 4e9));
    std::vector<std::uint8_t> stream;
    std::array<ImuSample, 2> sent;
    const bool utc = chance(0.5);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    for (std::size_t i = 0; i < 2; ++i) {
      ImuSample& s = sent[i];
      s.angular_rate_B_rad_s = draw3(3.0);
      s.specific_force_B_m_s2 = draw3(30.0);
      s.delta_time_s = 0.01;
      s.delta_angle_B_rad = draw3(0.03);
      s.delta_velocity_B_m_s = draw3(0.3);
      if (chance(0.5)) s.temperature_degC = draw(-10.0, 60.0);
      const auto message = sim::encode::xsens(
          s, static_cast<std::uint16_t>(65'000 + 2 * run + static_cast<int>(i)),
          (ticks + 100 * static_cast<std::int64_t>(i)) * 100'000, utc ? std::optional(utc_ns) : std::nullopt);
      stream.insert(stream.end(), message.begin(), message.end());
    }
    const auto got = read(codec::make_xsens({}), stream);
    ASSERT_EQ(got.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      const ImuSample& s = sent[i];
      const auto& r = std::get<ImuSample>(got[i].sample);
      EXPECT_EQ(got[i].time.clock_ns, (ticks + 100 * static_cast<std::int64_t>(i)) * 100'000);
      EXPECT_EQ(got[i].time.utc_ns, utc ? std::optional(utc_ns) : std::nullopt);
      expect_same3(s.angular_rate_B_rad_s, r.angular_rate_B_rad_s, 6e-8, 0.0);
      expect_same3(s.specific_force_B_m_s2, r.specific_force_B_m_s2, 6e-8, 0.0);
      EXPECT_EQ(known(r.temperature_degC), known(s.temperature_degC));
      EXPECT_EQ(known(r.delta_time_s), i == 1);  // the first one has no message before it
      if (i == 0) continue;
      EXPECT_NEAR(r.delta_time_s, 0.01, 1e-12);
      expect_same3(s.delta_angle_B_rad, r.delta_angle_B_rad, 2e-7, 0.0);
      expect_same3(s.delta_velocity_B_m_s, r.delta_velocity_B_m_s, 6e-8, 0.0);
    }
  }
}

TEST_F(RoundTrip, Stim300KeepsHalfACount) {
  constexpr std::array<double, 4> kRanges_g{5.0, 10.0, 30.0, 80.0};
  constexpr std::array<double, 3> kRates_Hz{0.0, 125.0, 2'000.0};
  for (int run = 0; run < kRuns; ++run) {
    const auto index = static_cast<std::size_t>(run);
    sim::encode::Stim300Frame frame;
    frame.options = {kRanges_g[index % 4], kRates_Hz[index % 3]};
    frame.latency_us = static_cast<std::uint16_t>(draw(0.0, 65'535.0));
    frame.line = chance(0.5);
    const bool increments = frame.options.increments_hz > 0.0;
    const double interval_s = increments ? 1.0 / frame.options.increments_hz : 0.01;
    ImuSample s;
    s.angular_rate_B_rad_s = draw3(6.0);
    s.specific_force_B_m_s2 = draw3(9.8 * frame.options.accel_range_g);
    for (std::size_t i = 0; i < 3; ++i) {
      s.delta_angle_B_rad[i] = s.angular_rate_B_rad_s[i] * interval_s;
      s.delta_velocity_B_m_s[i] = s.specific_force_B_m_s2[i] * interval_s;
    }
    if (chance(0.5)) s.temperature_degC = draw(-40.0, 85.0);
    const std::size_t lost = index % 5;  // an axis of the gyros; from 3 on none
    if (lost < 3) {
      s.angular_rate_B_rad_s[lost] = kUnknown;
      s.delta_angle_B_rad[lost] = kUnknown;
    }

    codec::CodecOptions reading;
    reading.stim300 = frame.options;
    const auto got = read(codec::make_stim300(reading), sim::encode::stim300(s, frame));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<ImuSample>(got[0].sample);
    EXPECT_EQ(got[0].time.age_ns, frame.latency_us * 1'000LL);
    EXPECT_EQ(known(r.temperature_degC), known(s.temperature_degC));
    if (known(s.temperature_degC)) {
      EXPECT_NEAR(r.temperature_degC, s.temperature_degC, 0.51 / 256.0);
    }
    const auto& turn = increments ? s.delta_angle_B_rad : s.angular_rate_B_rad_s;
    const auto& turn_read = increments ? r.delta_angle_B_rad : r.angular_rate_B_rad_s;
    const auto& push = increments ? s.delta_velocity_B_m_s : s.specific_force_B_m_s2;
    const auto& push_read = increments ? r.delta_velocity_B_m_s : r.specific_force_B_m_s2;
    const double turn_unit =
        increments ? codec::stim300::angle_unit_rad() : codec::stim300::rate_unit_rad_s();
    const double push_unit = increments ? codec::stim300::velocity_unit_m_s(frame.options.accel_range_g)
                                        : codec::stim300::force_unit_m_s2(frame.options.accel_range_g);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(known(turn_read[i]), i != lost);
      if (i != lost) {
        EXPECT_NEAR(turn_read[i], turn[i], 0.501 * turn_unit);
      }
      EXPECT_NEAR(push_read[i], push[i], 0.501 * push_unit);
    }
    EXPECT_EQ(known(r.delta_time_s), increments);
  }
}

TEST_F(RoundTrip, MicroStrainKeepsNanosecondsAndSinglePrecision) {
  for (int run = 0; run < kRuns; ++run) {
    const auto start_ns = static_cast<DurationNs>(draw(0.0, 4e15));
    std::vector<std::uint8_t> stream;
    std::array<ImuSample, 3> sent;
    const bool utc = chance(0.5);
    const bool increments_only = chance(0.3);
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    for (std::size_t i = 0; i < sent.size(); ++i) {
      ImuSample& s = sent[i];
      s.delta_time_s = 0.008;
      s.delta_angle_B_rad = draw3(0.03);
      s.delta_velocity_B_m_s = draw3(0.3);
      if (!increments_only) {
        s.angular_rate_B_rad_s = draw3(3.0);
        s.specific_force_B_m_s2 = draw3(30.0);
      }
      const auto packet = sim::encode::microstrain(s, start_ns + 8'000'000 * static_cast<DurationNs>(i),
                                                   utc ? std::optional(utc_ns) : std::nullopt);
      stream.insert(stream.end(), packet.begin(), packet.end());
    }
    const auto got = read(codec::make_microstrain({}), stream);
    const std::size_t first = increments_only ? 1 : 0;  // whose interval nobody knows yet
    ASSERT_EQ(got.size(), sent.size() - first);
    for (std::size_t i = first; i < sent.size(); ++i) {
      const ImuSample& s = sent[i];
      const codec::Decoded& decoded = got[i - first];
      const auto& r = std::get<ImuSample>(decoded.sample);
      EXPECT_EQ(decoded.time.clock_ns, start_ns + 8'000'000 * static_cast<DurationNs>(i));
      EXPECT_EQ(decoded.time.utc_ns, utc ? std::optional(utc_ns) : std::nullopt);
      EXPECT_EQ(known(r.delta_time_s), i > 0);
      if (i > 0) {
        EXPECT_NEAR(r.delta_time_s, 0.008, 1e-12);
        expect_same3(s.delta_angle_B_rad, r.delta_angle_B_rad, 6e-8, 0.0);
        expect_same3(s.delta_velocity_B_m_s, r.delta_velocity_B_m_s, 6e-8, 0.0);
      }
      if (increments_only) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(r.angular_rate_B_rad_s[axis], s.delta_angle_B_rad[axis] / 0.008, 1e-6);
          EXPECT_NEAR(r.specific_force_B_m_s2[axis], s.delta_velocity_B_m_s[axis] / 0.008, 1e-5);
        }
      } else {
        expect_same3(s.angular_rate_B_rad_s, r.angular_rate_B_rad_s, 6e-8, 0.0);
        expect_same3(s.specific_force_B_m_s2, r.specific_force_B_m_s2, 6e-8, 0.0);
      }
    }
  }
}

TEST_F(RoundTrip, Pd0InEveryFrame) {
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

TEST_F(RoundTrip, Pd0BeamsAreTheVelocityAlongThem) {
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

TEST_F(RoundTrip, Pd0WithAnyOneBeamLostKeepsTheVelocity) {
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

TEST_F(RoundTrip, Pd0WithWaterLayerAndLostBottom) {
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

TEST_F(RoundTrip, Pd6InEveryFrame) {
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

TEST_F(RoundTrip, WaterLinkedKeepsEveryBit) {
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

TEST_F(RoundTrip, NortekKeepsSinglePrecision) {
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

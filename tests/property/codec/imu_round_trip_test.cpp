// What the simulator's encoders of inertial units write, the codecs read back within the protocol's
// resolution.
#include <cmath>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "codec/imu/kvh.hpp"
#include "codec/imu/microstrain.hpp"
#include "codec/imu/sbg.hpp"
#include "codec/imu/stim300.hpp"
#include "codec/imu/vectornav.hpp"
#include "codec/imu/xsens.hpp"
#include "round_trip.hpp"
#include "sim/encode/imu/kvh.hpp"
#include "sim/encode/imu/microstrain.hpp"
#include "sim/encode/imu/sbg.hpp"
#include "sim/encode/imu/stim300.hpp"
#include "sim/encode/imu/vectornav.hpp"
#include "sim/encode/imu/xsens.hpp"

namespace fathom {
namespace {

using test::expect_same3;
using test::kRuns;
using test::kSomeTime_ns;
using test::read;

class ImuRoundTrip : public test::RoundTrip {};

TEST_F(ImuRoundTrip, VectorNavKeepsNanosecondsAndSinglePrecision) {
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

TEST_F(ImuRoundTrip, XsensKeepsTicksAndSinglePrecision) {
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

/// A fix of any kind that a satellite receiver knows, but dead reckoning.
class ImuFixRoundTrip : public test::RoundTrip {
 protected:
  GpsSample draw_fix() {
    constexpr std::array kKinds{GpsFix::none,         GpsFix::time_only, GpsFix::fix_2d,   GpsFix::fix_3d,
                                GpsFix::differential, GpsFix::rtk_float, GpsFix::rtk_fixed};
    GpsSample s;
    s.fix = kKinds[static_cast<std::size_t>(draw(0.0, 7.0))];
    s.satellites = static_cast<std::int32_t>(draw(0.0, 40.0));
    s.latitude_rad = draw(-90.0, 90.0) * kRadPerDeg;
    s.longitude_rad = draw(-180.0, 180.0) * kRadPerDeg;
    s.altitude_m = draw(-400.0, 9'000.0);
    s.altitude_msl_m = s.altitude_m + draw(-90.0, 90.0);
    s.velocity_N_m_s = draw3(300.0);
    s.position_sigma_N_m = {draw(0.01, 20.0), draw(0.01, 20.0), draw(0.01, 20.0)};
    s.velocity_sigma_N_m_s.fill(draw(0.01, 2.0));
    s.hdop = draw(0.5, 20.0);
    return s;
  }
};

TEST_F(ImuFixRoundTrip, VectorNavKeepsDegreesAndSinglePrecision) {
  for (int run = 0; run < kRuns; ++run) {
    const sim::encode::VectornavFix sent{draw_fix(), kSomeTime_ns + run * 10'000'001LL};
    const bool inertial = chance(0.5);
    ImuSample imu;
    imu.angular_rate_B_rad_s = draw3(3.0);
    imu.specific_force_B_m_s2 = draw3(30.0);
    const auto frame = inertial ? sim::encode::vectornav(imu, 1'000'000, std::nullopt, &sent)
                                : sim::encode::vectornav_fix(sent);
    const auto got = read(codec::make_vectornav({}), frame);
    ASSERT_EQ(got.size(), inertial ? 2U : 1U);
    if (inertial) {
      EXPECT_TRUE(std::holds_alternative<ImuSample>(got[0].sample));
    }
    const auto& r = std::get<GpsSample>(got.back().sample);
    const GpsSample& s = sent.sample;
    EXPECT_EQ(got.back().time.utc_ns, sent.utc_ns);
    EXPECT_EQ(r.fix, s.fix);
    EXPECT_EQ(r.satellites, s.satellites);
    ASSERT_EQ(known(r.latitude_rad), s.fix >= GpsFix::fix_2d);
    if (!known(r.latitude_rad)) continue;
    EXPECT_NEAR(r.latitude_rad, s.latitude_rad, 1e-15);
    EXPECT_NEAR(r.longitude_rad, s.longitude_rad, 1e-15);
    EXPECT_EQ(r.altitude_m, s.altitude_m);
    expect_same3(s.velocity_N_m_s, r.velocity_N_m_s, 6e-8, 0.0);
    expect_same3(s.position_sigma_N_m, r.position_sigma_N_m, 6e-8, 0.0);
    expect_same3(s.velocity_sigma_N_m_s, r.velocity_sigma_N_m_s, 6e-8, 0.0);
    EXPECT_NEAR(r.hdop, s.hdop, 6e-8 * s.hdop);
  }
}

TEST_F(ImuFixRoundTrip, XsensKeepsHalfACount) {
  constexpr double kHalf_m = 0.501e-3;
  constexpr double kHalf_rad = 0.501e-7 * kRadPerDeg;
  for (int run = 0; run < kRuns; ++run) {
    const GpsSample s = draw_fix();
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    ImuSample imu;
    imu.angular_rate_B_rad_s = draw3(3.0);
    imu.specific_force_B_m_s2 = draw3(30.0);
    const bool inertial = chance(0.5);
    auto message = sim::encode::xsens_fix(s, utc_ns);
    if (inertial) message = sim::encode::xsens_together(sim::encode::xsens(imu, 7, 1'000'000), message);
    const auto got = read(codec::make_xsens({}), message);
    ASSERT_EQ(got.size(), inertial ? 2U : 1U);
    if (inertial) {
      EXPECT_TRUE(std::holds_alternative<ImuSample>(got[0].sample));
    }
    const auto& r = std::get<GpsSample>(got.back().sample);
    EXPECT_EQ(got.back().time.utc_ns, utc_ns);
    EXPECT_EQ(r.fix, s.fix);
    EXPECT_EQ(r.satellites, s.satellites);
    ASSERT_EQ(known(r.latitude_rad), s.fix >= GpsFix::fix_2d);
    if (!known(r.latitude_rad)) continue;
    EXPECT_NEAR(r.latitude_rad, s.latitude_rad, kHalf_rad);
    EXPECT_NEAR(r.longitude_rad, s.longitude_rad, kHalf_rad);
    EXPECT_NEAR(r.altitude_m, s.altitude_m, kHalf_m);
    EXPECT_NEAR(r.altitude_msl_m, s.altitude_msl_m, kHalf_m);
    expect_same3(s.velocity_N_m_s, r.velocity_N_m_s, 0.0, kHalf_m);
    EXPECT_NEAR(std::hypot(r.position_sigma_N_m[0], r.position_sigma_N_m[1]),
                std::hypot(s.position_sigma_N_m[0], s.position_sigma_N_m[1]), kHalf_m);
    EXPECT_NEAR(r.position_sigma_N_m[2], s.position_sigma_N_m[2], kHalf_m);
    expect_same3(s.velocity_sigma_N_m_s, r.velocity_sigma_N_m_s, 0.0, kHalf_m);
    EXPECT_NEAR(r.hdop, s.hdop, 0.01);
  }
}

TEST_F(ImuRoundTrip, Stim300KeepsHalfACount) {
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

TEST_F(ImuRoundTrip, KvhKeepsSinglePrecisionAsItIsSet) {
  using codec::kvh::Format;
  for (int run = 0; run < kRuns; ++run) {
    sim::encode::KvhMessage message;
    message.format = run % 3 == 0 ? Format::a : run % 3 == 1 ? Format::b : Format::c;
    message.sequence = static_cast<std::uint16_t>(draw(0.0, 60'000.0));
    message.clock_us = static_cast<std::uint32_t>(draw(0.0, 4e9));
    message.options.increments_hz = chance(0.5) ? draw(1.0, 5'000.0) : 0.0;
    message.options.degrees = chance(0.5);
    message.options.temperature = static_cast<codec::KvhTemperature>(static_cast<int>(draw(0.0, 4.0)));
    ImuSample s;
    s.angular_rate_B_rad_s = draw3(8.0);
    s.specific_force_B_m_s2 = draw3(90.0);
    s.temperature_degC = draw(-40.0, 75.0);
    const auto lost = static_cast<std::size_t>(draw(0.0, 5.0));  // an axis of the gyros; from 3 on none
    if (lost < 3) s.angular_rate_B_rad_s[lost] = kUnknown;

    codec::CodecOptions reading;
    reading.kvh = message.options;
    const auto got = read(codec::make_kvh(reading), sim::encode::kvh(s, message));
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<ImuSample>(got[0].sample);
    EXPECT_EQ(got[0].time.clock_ns.has_value(), message.format == Format::b);
    if (message.format == Format::b) {
      EXPECT_EQ(got[0].time.clock_ns, message.clock_us * 1'000LL);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(known(r.angular_rate_B_rad_s[i]), i != lost);
      if (i != lost) {
        EXPECT_NEAR(r.angular_rate_B_rad_s[i], s.angular_rate_B_rad_s[i], 1e-6);
      }
    }
    expect_same3(s.specific_force_B_m_s2, r.specific_force_B_m_s2, 6e-8, 0.0);
    const bool has_temperature = message.format != Format::c || message.sequence % 4 == 0;
    ASSERT_EQ(known(r.temperature_degC), has_temperature);
    if (has_temperature) {
      EXPECT_NEAR(r.temperature_degC, s.temperature_degC, message.format == Format::c ? 1e-4 : 0.51);
    }
  }
}

TEST_F(ImuRoundTrip, SbgKeepsMicrosecondsAndCounts) {
  for (int run = 0; run < kRuns; ++run) {
    ImuSample s;
    const bool fast = chance(0.3);
    s.angular_rate_B_rad_s = draw3(fast ? 90.0 : 6.0);
    s.specific_force_B_m_s2 = draw3(390.0);
    s.temperature_degC = draw(-40.0, 85.0);
    const std::size_t lost =
        static_cast<std::size_t>(run) % 5;  // an axis of the accelerometers; from 3 on none
    if (lost < 3) s.specific_force_B_m_s2[lost] = kUnknown;
    const DurationNs since_startup_ns = static_cast<DurationNs>(draw(0.0, 4e12));
    const TimeNs utc_ns = kSomeTime_ns + run * 10'000'001LL;
    const bool utc = chance(0.5);
    const bool in_short = chance(0.5);

    std::vector<std::uint8_t> stream;
    if (utc) stream = sim::encode::sbg_utc_time(utc_ns, since_startup_ns);
    const auto frame = in_short ? sim::encode::sbg_imu_short(s, since_startup_ns)
                                : sim::encode::sbg_imu_data(s, since_startup_ns);
    stream.insert(stream.end(), frame.begin(), frame.end());
    const auto got = read(codec::make_sbg({}), stream);
    ASSERT_EQ(got.size(), 1U);
    const auto& r = std::get<ImuSample>(got[0].sample);
    EXPECT_EQ(got[0].time.clock_ns, since_startup_ns / 1'000 * 1'000);
    EXPECT_EQ(got[0].time.utc_ns, utc ? std::optional(utc_ns) : std::nullopt);
    const double rate_unit = 1.0 / (fast ? codec::sbg::kHighRateCounts : codec::sbg::kRateCounts);
    expect_same3(s.angular_rate_B_rad_s, r.angular_rate_B_rad_s, 6e-8, in_short ? 0.501 * rate_unit : 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(known(r.specific_force_B_m_s2[i]), i != lost);
      if (i == lost) continue;
      EXPECT_NEAR(r.specific_force_B_m_s2[i], s.specific_force_B_m_s2[i],
                  in_short ? 0.501 / codec::sbg::kForceCounts : 6e-8 * 390.0);
    }
    EXPECT_NEAR(r.temperature_degC, s.temperature_degC, in_short ? 0.51 / 256.0 : 6e-6);
  }
}

TEST_F(ImuRoundTrip, MicroStrainKeepsNanosecondsAndSinglePrecision) {
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

}  // namespace
}  // namespace fathom

#include "codec/imu/kvh.hpp"

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "base/unknown.hpp"
#include "capture.hpp"
#include "codec/crc32.hpp"

namespace fathom::codec::kvh_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;

constexpr double kG = 9.80665;

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ByteVector hex(const std::string& text) {
  ByteVector out;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    out.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return out;
}

ByteVector real(float value) {
  ByteVector out;
  append_be<float>(out, value);
  return out;
}

ByteVector message(std::uint8_t format, const ByteVector& rotation, const ByteVector& rest) {
  ByteVector out =
      ByteVector{0xFE, 0x81, 0xFF, format} + rotation + real(0.5F) + real(-0.25F) + real(1.0F) + rest;
  append_be<std::uint32_t>(out, crc32_mpeg2(out));
  return out;
}

const ByteVector kTurn = real(0.5F) + real(-0.25F) + real(0.125F);
const ByteVector kGood = message(0x55, kTurn, {0x77, 5, 0, 25});

/// Messages of a 1750 at rest that gives delta angles, kept by TRECVT/ros_kvh1750 (test/utest.cpp) with what
/// is in them: just switched on, later, and one that was damaged on the line.
const ByteVector kSwitchedOn =
    hex("FE81FF553B041F78B9B96613BA234B38BB7C0410B8DEF4803F7F4B7B701F001DF12FB6EE");
const ByteVector kAtRest = hex("FE81FF55B3D0BBE732193EF430AC19A5BA8F78D63A2905943F7ECBD47768001DADC5F651");
const ByteVector kDamaged = hex("FE81FF55B46B86C6B44F5B83B4106D09BB713CB7BBABD9143F7E319A7769001D95BBDB4F");

std::vector<ImuSample> imu_of(const Harvest& run) {
  std::vector<ImuSample> out;
  for (const auto& [decoded, sample] : of_kind<ImuSample>(run)) out.push_back(sample);
  return out;
}

CodecOptions set_to(const KvhOptions& kvh) {
  CodecOptions options;
  options.kvh = kvh;
  return options;
}

TEST(Kvh, ReadsAUnitAtRest) {
  const Harvest run = decode("kvh", kAtRest, {}, set_to({1'000.0, false, KvhTemperature::celsius}));
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_NEAR(imu[0].angular_rate_B_rad_s[0], -9.719934e-5, 1e-11);
  EXPECT_NEAR(imu[0].angular_rate_B_rad_s[1], 8.920086e-6, 1e-12);
  EXPECT_NEAR(imu[0].angular_rate_B_rad_s[2], 1.252194e-6, 1e-12);
  EXPECT_NEAR(imu[0].specific_force_B_m_s2[0], -0.00109460461 * kG, 1e-9);
  EXPECT_NEAR(imu[0].specific_force_B_m_s2[2], 0.99529767 * kG, 1e-7);  // z is up
  EXPECT_EQ(imu[0].temperature_degC, 29.0);
  EXPECT_FALSE(known(imu[0].delta_time_s));
  EXPECT_FALSE(run.samples[0].time.clock_ns.has_value());
}

TEST(Kvh, GyrosThatAreNotReadyAreUnknown) {
  const auto imu = imu_of(decode("kvh", kSwitchedOn));
  ASSERT_EQ(imu.size(), 1U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FALSE(known(imu[0].angular_rate_B_rad_s[i]));
    EXPECT_TRUE(known(imu[0].specific_force_B_m_s2[i]));
  }
  EXPECT_NEAR(imu[0].specific_force_B_m_s2[2], 0.99724549 * kG, 1e-7);
}

TEST(Kvh, EachBitOfTheStatusIsOfOneAxis) {
  for (unsigned bit : {0U, 1U, 2U, 4U, 5U, 6U}) {
    const auto status = static_cast<std::uint8_t>(0x77U & ~(1U << bit));
    const auto imu = imu_of(decode("kvh", message(0x55, kTurn, {status, 5, 0, 25})));
    ASSERT_EQ(imu.size(), 1U) << bit;
    for (unsigned axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(known(imu[0].angular_rate_B_rad_s[axis]), bit != axis) << bit;
      EXPECT_EQ(known(imu[0].specific_force_B_m_s2[axis]), bit != axis + 4) << bit;
    }
  }
}

TEST(Kvh, RotationIsWhatTheUnitWasSetTo) {
  struct Case {
    double increments_hz;
    bool degrees;
    double expected_rad_s;
  };
  for (const Case& c : {Case{0.0, false, 0.5},
                        {0.0, true, 0.5 * kRadPerDeg},
                        {10.0, false, 5.0},
                        {250.0, true, 125.0 * kRadPerDeg}}) {
    const auto imu =
        imu_of(decode("kvh", kGood, {}, set_to({c.increments_hz, c.degrees, KvhTemperature::celsius})));
    ASSERT_EQ(imu.size(), 1U);
    EXPECT_DOUBLE_EQ(imu[0].angular_rate_B_rad_s[0], c.expected_rad_s);
    EXPECT_DOUBLE_EQ(imu[0].angular_rate_B_rad_s[1], -0.5 * c.expected_rad_s);
    EXPECT_DOUBLE_EQ(imu[0].specific_force_B_m_s2[0], 0.5 * kG);
  }
}

TEST(Kvh, TemperatureIsInTheUnitThatItWasSetTo) {
  struct Case {
    std::int16_t reading;
    KvhTemperature unit;
    double expected_degC;
  };
  for (const Case& c : {Case{-12, KvhTemperature::celsius, -12.0},
                        {-1'234, KvhTemperature::celsius_100, -12.34},
                        {86, KvhTemperature::fahrenheit, 30.0},
                        {8'609, KvhTemperature::fahrenheit_100, 30.05}}) {
    ByteVector rest{0x77, 5};
    append_be<std::int16_t>(rest, c.reading);
    const auto imu = imu_of(decode("kvh", message(0x55, kTurn, rest), {}, set_to({0.0, false, c.unit})));
    ASSERT_EQ(imu.size(), 1U);
    EXPECT_NEAR(imu[0].temperature_degC, c.expected_degC, 1e-12);
    EXPECT_NEAR(kvh::from_degC(c.expected_degC, c.unit), c.reading, 1e-8);
  }
  // Hundredths read as degrees: no temperature, and nothing else is lost.
  const auto imu = imu_of(decode("kvh", message(0x55, kTurn, {0x77, 5, 0x0B, 0x54})));
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_FALSE(known(imu[0].temperature_degC));
  EXPECT_EQ(imu[0].angular_rate_B_rad_s[0], 0.5);
}

TEST(Kvh, FormatBHasAClockThatGoesOnBehindItsEnd) {
  const Harvest run = decode("kvh", message(0x56, kTurn, {0xFF, 0xFF, 0xFF, 0x00, 0x77, 127, 0, 25}) +
                                        message(0x56, kTurn, {0x00, 0x00, 0x02, 0xE8, 0x77, 0, 0, 26}));
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(run.samples[0].time.clock_ns, 4'294'967'040'000);
  EXPECT_EQ(run.samples[1].time.clock_ns, 4'294'968'040'000);
  EXPECT_EQ(imu_of(run)[1].temperature_degC, 26.0);
}

TEST(Kvh, FormatCHasTheTemperatureInEveryFourthMessage) {
  ByteVector stream;
  for (const std::uint8_t sequence : {126, 127, 0, 1})
    stream = stream + message(0x57, kTurn, real(21.5F) + ByteVector{0x77, sequence});
  const auto imu = imu_of(decode("kvh", stream));
  ASSERT_EQ(imu.size(), 4U);
  EXPECT_EQ(imu[2].temperature_degC, 21.5);
  for (const std::size_t i : {0U, 1U, 3U}) EXPECT_FALSE(known(imu[i].temperature_degC)) << i;
  for (const ImuSample& s : imu) EXPECT_EQ(s.angular_rate_B_rad_s[0], 0.5);
}

// As the manual prints both; a sum that does not hold is a fault.
TEST(Kvh, ResultsOfBuiltInTestsAreIgnored) {
  const ByteVector test = hex("FE8100AA7F7F7F7F7F7F23");
  ByteVector damaged = test;
  damaged[6] = 0x7B;
  const Harvest run = decode("kvh", test + kGood + hex("FE8100AB7F7F7F7F7F7F377FDA") + damaged + kGood);
  EXPECT_EQ(run.totals.frames_ignored, 2U);
  EXPECT_EQ(run.totals.samples, 2U);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::checksum);
}

TEST(Kvh, FaultsAreRefusedOnceAndTheNextMessageIsFound) {
  const ByteVector no_number = real(std::nanf("")) + real(0.0F) + real(0.0F);
  const ByteVector spinning = real(0.0F) + real(0.0F) + real(18.0F);
  for (const auto& [bad, reason] :
       {std::pair{kDamaged, RejectReason::checksum},
        {message(0x55, kTurn, {0x7F, 5, 0, 25}), RejectReason::structure},
        {message(0x55, kTurn, {0x77, 128, 0, 25}), RejectReason::structure},
        {message(0x55, no_number, {0x77, 5, 0, 25}), RejectReason::out_of_range},
        {message(0x55, spinning, {0x77, 5, 0, 25}), RejectReason::out_of_range}}) {
    const Harvest run = decode("kvh", bad + kGood);
    ASSERT_EQ(run.rejected.size(), 1U);
    EXPECT_EQ(run.rejected[0].reason, reason);
    EXPECT_EQ(run.rejected[0].offset, 0U);
    EXPECT_EQ(run.totals.samples, 1U);
  }
  // What an axis says that is not valid does not count.
  EXPECT_EQ(decode("kvh", message(0x55, no_number, {0x76, 5, 0, 25})).totals.samples, 1U);
  const Harvest cut = decode("kvh", ByteVector(kGood.begin(), kGood.end() - 3));
  ASSERT_EQ(cut.rejected.size(), 1U);
  EXPECT_EQ(cut.rejected[0].reason, RejectReason::truncated);
  EXPECT_EQ(decode("kvh", hex("FE81FF58FE8100ACFE82") + kGood).totals.skipped_bytes, 10U);
}

}  // namespace
}  // namespace fathom::codec::kvh_test

#include "codec/imu/stim300.hpp"

#include <array>
#include <span>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "base/bytes/big_endian.hpp"
#include "base/units.hpp"
#include "capture.hpp"

namespace fathom::codec::stim300_test {
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

/// Three numbers of 24 bits and their status.
ByteVector triad(std::array<int, 3> counts, std::uint8_t status = 0) {
  ByteVector out;
  for (const int count : counts) {
    for (const int shift : {16, 8, 0}) out.push_back(static_cast<std::uint8_t>(count >> shift));
  }
  out.push_back(status);
  return out;
}

/// Three numbers of 16 bits and their status.
ByteVector temperatures(std::array<int, 3> counts, std::uint8_t status = 0) {
  ByteVector out;
  for (const int count : counts) append_be<std::int16_t>(out, static_cast<std::int16_t>(count));
  out.push_back(status);
  return out;
}

ByteVector with_crc(ByteVector bytes) {
  append_be<std::uint32_t>(bytes, stim300::crc32(bytes));
  return bytes;
}

const ByteVector kTail{0x11, 0x01, 0xF4};  // counter, latency 500 us

ByteVector datagram(std::uint8_t identifier, const ByteVector& middle) {
  return with_crc(ByteVector{identifier} + middle + kTail);
}

const ByteVector kTurn = triad({16'384, -32'768, 8'192});  // 1, -2, 0.5 deg/s
const ByteVector kPush = triad({524'288, -262'144, 1});    // at 10 g: 1, -0.5 g and a count
const ByteVector kTilt = triad({4'194'304, 0, 0});         // 1 g
const ByteVector kGood = datagram(0x91, kTurn + kPush);

std::vector<ImuSample> imu_of(const Harvest& run) {
  std::vector<ImuSample> out;
  for (const auto& [decoded, sample] : of_kind<ImuSample>(run)) out.push_back(sample);
  return out;
}

ByteVector from_hex(const std::string& text) {
  ByteVector out;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    out.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return out;
}

/// A unit at rest, read by geirhovland/stim300 (README.md), which prints every value and the CRC.
const ByteVector kAtRest = from_hex(
    "af000124fffad600035b00ffe7a6ffdd36081c5200ff7e70feba0c3ffa1d0023a023c023a0002319230a231c00239523b6239500"
    "ffef0200e101fac64942c6");
/// A unit of revision B at rest, kept by rock-drivers/drivers-imu_stim300 (src/Main.cpp) with its CRC.
const ByteVector kOldUnit =
    from_hex("970001370001c7fffe74000006320011ad07f44500ffecbc00379340062a00204f2069205500d903f821c1e045");

TEST(Stim300, TheCrcIsThatOfTwoUnits) {
  EXPECT_EQ(stim300::crc32(std::span(kAtRest).first(kAtRest.size() - 4)), 3'326'689'990U);
  EXPECT_EQ(stim300::crc32(std::span(kOldUnit).first(kOldUnit.size() - 4)), 0x21C1'E045U);
}

TEST(Stim300, ReadsWhatAnotherDriverReads) {
  const Harvest run = decode("stim300", kAtRest);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  const ImuSample& s = imu[0];
  EXPECT_DOUBLE_EQ(s.angular_rate_B_rad_s[0], 0.017822265625 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(s.angular_rate_B_rad_s[1], -0.0806884765625 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(s.angular_rate_B_rad_s[2], 0.05242919921875 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(s.specific_force_B_m_s2[0], -0.011890411376953125 * kG);
  EXPECT_DOUBLE_EQ(s.specific_force_B_m_s2[1], -0.016986846923828125 * kG);
  EXPECT_DOUBLE_EQ(s.specific_force_B_m_s2[2], 1.0138282775878906 * kG);  // z is up
  EXPECT_DOUBLE_EQ(s.temperature_degC, (35.625 + 35.75 + 35.625) / 3.0);
  EXPECT_EQ(run.samples[0].time.age_ns, 506'000);
  EXPECT_FALSE(run.samples[0].time.clock_ns.has_value());
  EXPECT_FALSE(known(s.delta_time_s));
  EXPECT_FALSE(known(s.delta_angle_B_rad[0]));
}

TEST(Stim300, ReadsAnOldUnit) {
  const Harvest run = decode("stim300", kOldUnit);
  EXPECT_EQ(run.totals.rejected, 0U);
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_DOUBLE_EQ(imu[0].angular_rate_B_rad_s[0], 311.0 / 16'384.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(imu[0].angular_rate_B_rad_s[2], -396.0 / 16'384.0 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(imu[0].specific_force_B_m_s2[2], 521'285.0 / 524'288.0 * kG);
  EXPECT_DOUBLE_EQ(imu[0].temperature_degC, (8'271.0 + 8'297.0 + 8'277.0) / 256.0 / 3.0);
  EXPECT_EQ(run.samples[0].time.age_ns, 1'016'000);
}

// Zeros behind the datagram that count in its CRC: table 5-22 of the data sheet.
TEST(Stim300, EveryIdentifierHasTheLengthOfItsPadding) {
  struct Case {
    std::uint8_t identifier;
    std::size_t length;
    std::size_t zeros;
  };
  for (const Case& c : {Case{0x90, 18, 2},
                        {0x91, 28, 0},
                        {0x92, 28, 0},
                        {0x93, 38, 2},
                        {0x94, 25, 3},
                        {0x98, 22, 2},
                        {0x99, 32, 0},
                        {0x9A, 32, 0},
                        {0x9B, 42, 2},
                        {0x9C, 29, 3},
                        {0xA5, 42, 2},
                        {0xA6, 42, 2},
                        {0xA7, 59, 1},
                        {0xAD, 46, 2},
                        {0xAE, 46, 2},
                        {0xAF, 63, 1},
                        {0x97, 45, 3},
                        {0xF1, 32, 0},
                        {0xF7, 63, 1}}) {
    const auto triads = stim300::triads_of(c.identifier);
    ASSERT_TRUE(triads) << int{c.identifier};
    EXPECT_EQ(triads->length(), c.length) << int{c.identifier};
    EXPECT_EQ((c.length - 4 + c.zeros) % 4, 0U) << int{c.identifier};
  }
  for (const int none : {0x8F, 0xA0, 0xA3, 0xA4, 0xA8, 0xAB, 0xAC, 0xB0, 0xBC, 0xF8, 0xFF})
    EXPECT_FALSE(stim300::triads_of(static_cast<std::uint8_t>(none))) << none;
}

TEST(Stim300, ReadsEveryDatagramWithAccelerometers) {
  const ByteVector t = temperatures({5'120, 5'376, 5'632});  // 20, 21, 22 degC
  const ByteVector aux{0x12, 0x34, 0x56, 0x00};
  const ByteVector both = kTurn + kPush;
  for (const ByteVector& bytes :
       {datagram(0x91, both), datagram(0x93, both + kTilt), datagram(0xA5, both + t + t),
        datagram(0xA7, both + kTilt + t + t + t), datagram(0x99, both + aux),
        datagram(0x9B, both + kTilt + aux), datagram(0xAD, both + t + t + aux),
        datagram(0xAF, both + kTilt + t + t + t + aux), datagram(0x95, both + t),
        datagram(0x97, both + kTilt + t), datagram(0xF1, both + aux),
        datagram(0xF7, both + kTilt + t + t + t + aux)}) {
    const auto identifier = int{bytes[0]};
    const Harvest run = decode("stim300", bytes + ByteVector{'\r', '\n'} + bytes);
    EXPECT_EQ(run.totals.skipped_bytes, 0U) << identifier;
    EXPECT_EQ(run.totals.rejected, 0U) << identifier;
    const auto imu = imu_of(run);
    ASSERT_EQ(imu.size(), 2U) << identifier;
    EXPECT_DOUBLE_EQ(imu[1].angular_rate_B_rad_s[0], 1.0 * kRadPerDeg) << identifier;
    EXPECT_DOUBLE_EQ(imu[1].angular_rate_B_rad_s[1], -2.0 * kRadPerDeg) << identifier;
    EXPECT_DOUBLE_EQ(imu[1].angular_rate_B_rad_s[2], 0.5 * kRadPerDeg) << identifier;
    EXPECT_DOUBLE_EQ(imu[1].specific_force_B_m_s2[0], kG) << identifier;
    EXPECT_DOUBLE_EQ(imu[1].specific_force_B_m_s2[1], -0.5 * kG) << identifier;
    EXPECT_DOUBLE_EQ(imu[1].specific_force_B_m_s2[2], kG / 524'288.0) << identifier;
    const bool warm = (bytes[0] & 4U) != 0;
    EXPECT_EQ(known(imu[1].temperature_degC), warm) << identifier;
    if (warm) {
      EXPECT_DOUBLE_EQ(imu[1].temperature_degC, 21.0) << identifier;
    }
    EXPECT_EQ(run.samples[1].time.age_ns, 500'000) << identifier;
  }
}

TEST(Stim300, DatagramsWithoutAccelerometersAreIgnored) {
  const ByteVector t = temperatures({0, 0, 0});
  const Harvest run = decode(
      "stim300", datagram(0x90, kTurn) + datagram(0x92, kTurn + kTilt) + datagram(0x94, kTurn + t) +
                     datagram(0xA6, kTurn + kTilt + t + t) + with_crc(ByteVector{0xB1} + ByteVector(15, 7)) +
                     with_crc(ByteVector{0xB7} + ByteVector(15, 7)) + ByteVector{'\r', '\n'} +
                     with_crc(ByteVector{0xBE} + ByteVector(16, 0)) +
                     with_crc(ByteVector{0xD1} + ByteVector(35, 0)) + kGood);
  EXPECT_EQ(run.totals.frames_ignored, 8U);
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

// Table 5-23. What it says of one triad says nothing of the other.
TEST(Stim300, StatusDecidesWhichAxesAreKnown) {
  struct Case {
    std::uint8_t status;
    std::array<bool, 3> known;
  };
  for (const Case& c : {Case{0x00, {true, true, true}},
                        {0x20, {true, true, true}},     // outside of the operating conditions
                        {0x80, {false, false, false}},  // system integrity
                        {0x40, {false, false, false}},  // start-up
                        {0x11, {false, true, true}},    // overload of x
                        {0x0A, {true, false, true}},    // error of channel y
                        {0x1C, {true, true, false}},
                        {0x0F, {false, false, false}},
                        {0x10, {false, false, false}},  // of which axis it does not say
                        {0x08, {false, false, false}}}) {
    const auto imu = imu_of(decode("stim300", datagram(0x91, triad({1, 2, 3}, c.status) + kPush) +
                                                  datagram(0x91, kTurn + triad({1, 2, 3}, c.status))));
    ASSERT_EQ(imu.size(), 2U);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(known(imu[0].angular_rate_B_rad_s[axis]), c.known[axis]) << int{c.status};
      EXPECT_TRUE(known(imu[0].specific_force_B_m_s2[axis])) << int{c.status};
      EXPECT_EQ(known(imu[1].specific_force_B_m_s2[axis]), c.known[axis]) << int{c.status};
      EXPECT_TRUE(known(imu[1].angular_rate_B_rad_s[axis])) << int{c.status};
    }
  }
}

TEST(Stim300, TemperaturesInErrorDoNotCount) {
  const ByteVector t = temperatures({2'560, 5'120, 7'680});
  const auto at = [&](std::uint8_t status) {
    return imu_of(decode("stim300",
                         datagram(0xA5, kTurn + kPush + temperatures({2'560, 5'120, 7'680}, status) + t)))
        .at(0)
        .temperature_degC;
  };
  EXPECT_DOUBLE_EQ(at(0x00), 20.0);
  EXPECT_DOUBLE_EQ(at(0x0C), 15.0);
  EXPECT_FALSE(known(at(0x80)));
}

TEST(Stim300, TheRangeGivesTheScale) {
  struct Case {
    double range_g;
    double counts_per_g;
  };
  for (const Case& c : {Case{5.0, 1'048'576.0}, {10.0, 524'288.0}, {30.0, 262'144.0}, {80.0, 65'536.0}}) {
    CodecOptions options;
    options.stim300.accel_range_g = c.range_g;
    const auto imu = imu_of(decode("stim300", kGood, {}, options));
    ASSERT_EQ(imu.size(), 1U);
    EXPECT_DOUBLE_EQ(imu[0].specific_force_B_m_s2[1], -262'144.0 / c.counts_per_g * kG) << c.range_g;
    EXPECT_DOUBLE_EQ(imu[0].angular_rate_B_rad_s[1], -2.0 * kRadPerDeg) << c.range_g;
  }
}

TEST(Stim300, IncrementsAreThoseOfOneInterval) {
  struct Case {
    double range_g;
    double counts_per_m_s;
  };
  for (const Case& c :
       {Case{5.0, 8'388'608.0}, {10.0, 4'194'304.0}, {30.0, 2'097'152.0}, {80.0, 524'288.0}}) {
    CodecOptions options;
    options.stim300 = {c.range_g, 500.0};
    const auto imu = imu_of(decode(
        "stim300", datagram(0x91, triad({2'097, -4'194, 0}) + triad({41'943, 0, -4'194})), {}, options));
    ASSERT_EQ(imu.size(), 1U);
    const ImuSample& s = imu[0];
    EXPECT_DOUBLE_EQ(s.delta_time_s, 0.002);
    EXPECT_DOUBLE_EQ(s.delta_angle_B_rad[0], 2'097.0 / 2'097'152.0 * kRadPerDeg);
    EXPECT_DOUBLE_EQ(s.delta_velocity_B_m_s[2], -4'194.0 / c.counts_per_m_s);
    EXPECT_DOUBLE_EQ(s.angular_rate_B_rad_s[1], -4'194.0 / 2'097'152.0 * kRadPerDeg / 0.002);
    EXPECT_DOUBLE_EQ(s.specific_force_B_m_s2[0], 41'943.0 / c.counts_per_m_s / 0.002);
  }
}

/// Table 5-16: `rate` in the top bits of byte 3, output units, range of x.
ByteVector configuration(std::uint8_t rate, std::uint8_t gyros, std::uint8_t accelerometers,
                         std::uint8_t range) {
  ByteVector out(22, 0);
  out[0] = 0xBC;
  out[1] = 'L';
  out[2] = 27;
  out[3] = static_cast<std::uint8_t>(rate << 5U | 0x02U);
  out[5] = static_cast<std::uint8_t>(0x70U | gyros);
  out[8] = static_cast<std::uint8_t>(0x70U | accelerometers);
  out[17] = static_cast<std::uint8_t>(range << 4U | range);
  out[18] = static_cast<std::uint8_t>(range << 4U);
  return with_crc(out);
}

TEST(Stim300, TheConfigurationGoesBeforeTheOptions) {
  CodecOptions options;
  options.stim300 = {80.0, 2'000.0};
  struct Case {
    ByteVector bytes;
    double x_m_s2;
    double interval_s;
  };
  for (const Case& c : {Case{configuration(2, 0, 0, 3), 0.5 * kG, kUnknown},  // 500 Hz, at 5 g
                        {configuration(2, 2, 2, 4), 2.0 * kG, kUnknown},      // averages, at 30 g
                        {configuration(5, 0, 0, 0), 1.0 * kG, kUnknown},      // external trigger, at 10 g
                        {configuration(0, 8, 0, 0), 1.0 * kG, kUnknown},      // delayed gyros
                        {configuration(0, 1, 1, 0), 0.125 / 0.008, 0.008},    // increments at 125 Hz
                        {configuration(1, 5, 1, 6), 8.0 * 0.125 / 0.004, 0.004},
                        {configuration(3, 0, 1, 0), 0.125 / 0.001, kUnknown}}) {  // of velocity only
    const Harvest run = decode("stim300", c.bytes + kGood, {}, options);
    EXPECT_EQ(run.totals.frames_ignored, 1U);
    const auto imu = imu_of(run);
    ASSERT_EQ(imu.size(), 1U);
    EXPECT_DOUBLE_EQ(imu[0].specific_force_B_m_s2[0], c.x_m_s2);
    EXPECT_EQ(known(imu[0].delta_time_s), known(c.interval_s));
    EXPECT_EQ(known(imu[0].delta_angle_B_rad[0]), known(c.interval_s));
    if (known(c.interval_s)) {
      EXPECT_DOUBLE_EQ(imu[0].delta_time_s, c.interval_s);
    }
  }
}

TEST(Stim300, WhatNobodyCanReadIsIgnored) {
  for (const ByteVector& bytes :
       {configuration(4, 3, 0, 0), configuration(4, 0, 3, 0), configuration(4, 0, 4, 0),  // integrated
        configuration(5, 1, 1, 0), configuration(7, 1, 0, 0)}) {                          // interval unknown
    const Harvest run = decode("stim300", bytes + kGood);
    EXPECT_EQ(run.totals.samples, 0U);
    EXPECT_EQ(run.totals.frames_ignored, 2U);
  }
  const auto imu = imu_of(decode("stim300", configuration(4, 0, 0, 9) + kGood));  // no such range
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_TRUE(known(imu[0].angular_rate_B_rad_s[0]));
  EXPECT_FALSE(known(imu[0].specific_force_B_m_s2[0]));
}

TEST(Stim300, FaultsAreRefusedOnceAndTheNextDatagramIsFound) {
  auto damaged = kGood;
  damaged[5] ^= 0x40U;
  CodecOptions fast;
  fast.stim300 = {10.0, 2'000.0};
  const ByteVector spinning = datagram(0x91, triad({8'000'000, 0, 0}) + triad({0, 0, 1'000}));
  const ByteVector still = datagram(0x91, triad({1, 0, 0}) + triad({0, 0, 1'000}));
  for (const auto& [run, reason] :
       {std::pair{decode("stim300", damaged + kGood), RejectReason::checksum},
        {decode("stim300", spinning + still, {}, fast), RejectReason::out_of_range}}) {
    ASSERT_EQ(run.rejected.size(), 1U);
    EXPECT_EQ(run.rejected[0].reason, reason);
    EXPECT_EQ(run.rejected[0].offset, 0U);
    EXPECT_EQ(run.totals.samples, 1U);
  }
  const ByteVector cut(kGood.begin(), kGood.end() - 3);
  const Harvest run = decode("stim300", cut);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::truncated);
}

}  // namespace
}  // namespace fathom::codec::stim300_test

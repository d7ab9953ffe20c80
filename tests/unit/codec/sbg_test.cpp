#include "codec/imu/sbg.hpp"

#include <array>
#include <limits>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "capture.hpp"

namespace fathom::codec::sbg_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;

constexpr std::uint16_t kWell = 0x3FF;

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ByteVector from_hex(const std::string& text) {
  ByteVector out;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    out.push_back(static_cast<std::uint8_t>(std::stoi(text.substr(i, 2), nullptr, 16)));
  return out;
}

ByteVector frame(std::uint8_t message, std::uint8_t message_class, const ByteVector& data) {
  ByteVector out{0xFF, 0x5A, message, message_class};
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  out = out + data;
  append_le<std::uint16_t>(out, sbg::crc16(std::span(out).subspan(2)));
  out.push_back(0x33);
  return out;
}

ByteVector imu_short(std::uint32_t stamp_us, std::uint16_t status = kWell,
                     std::array<std::int32_t, 3> rate = {67'108'864, -33'554'432, 1}) {
  ByteVector data;
  append_le<std::uint32_t>(data, stamp_us);
  append_le<std::uint16_t>(data, status);
  for (const std::int32_t force : {1'048'576, 0, -10'485'760}) append_le<std::int32_t>(data, force);
  for (const std::int32_t count : rate) append_le<std::int32_t>(data, count);
  append_le<std::int16_t>(data, 6'400);
  return frame(44, 0, data);
}

ByteVector imu_data(std::uint32_t stamp_us, std::uint16_t status = kWell, float rate_x = 0.5F,
                    float force_x = 0.25F, float temperature = 31.5F) {
  ByteVector data;
  append_le<std::uint32_t>(data, stamp_us);
  append_le<std::uint16_t>(data, status);
  for (const float v :
       {force_x, -0.125F, -9.75F, rate_x, -0.25F, 0.125F, temperature, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F})
    append_le<float>(data, v);
  return frame(3, 0, data);
}

/// 2026-09-19 10:30:15.25 at the stamp.
ByteVector utc_time(std::uint32_t stamp_us, std::uint16_t status = 0x00A6, std::uint8_t second = 15,
                    std::int32_t nanosecond = 250'000'000, std::uint8_t month = 9) {
  ByteVector data;
  append_le<std::uint32_t>(data, stamp_us);
  append_le<std::uint16_t>(data, status);
  append_le<std::uint16_t>(data, 2026);
  data = data + ByteVector{month, 19, 10, 30, second};
  append_le<std::int32_t>(data, nanosecond);
  append_le<std::uint32_t>(data, 37'815'250);
  return frame(2, 0, data);
}

std::vector<ImuSample> imu_of(const Harvest& run) {
  std::vector<ImuSample> out;
  for (const auto& [decoded, sample] : of_kind<ImuSample>(run)) out.push_back(sample);
  return out;
}

/// MAG of a unit on a logic analyser (crate sbg_hal, tests).
const ByteVector kRecorded =
    from_hex("ff5a04001e00e811920aff01402f903e80e285bd651e9cbe84adc4be3c101dc125b7073fe49933");
// Made by another program (nekosaif/mtrtk, tests/fixtures/ins/sbg_frames.hex): EKF_NAV, UTC_TIME, IMU_SHORT,
// and the answer to a command.
const ByteVector kNavigation = from_hex(
    "ff5a0800480040e201000000003f000080be0ad7233c0ad7a33c0ad7a33ccdcc4c3d0ad7a3703dba374085eb51b81e9956400000"
    "0000"
    "00002940cdcc5cc29a99993e9a99993e9a99193fc40000005c2433");
const ByteVector kUtc =
    from_hex("ff5a0200210040e20100a600ea0709130a1e0f80b2e60ed203410277cc2b325f70893077ccab326c8333");
const ByteVector kShort =
    from_hex("ff5a2c00200040e20100000000001000000000000000e0ff00000004000000000000000000195b5233");
const ByteVector kAnswer = from_hex("ff5a001004001e100000134d33");

TEST(Sbg, TheCrcIsThatOfTheUnitAndOfOthers) {
  const std::string digits = "123456789";
  EXPECT_EQ(sbg::crc16(ByteVector(digits.begin(), digits.end())), 0x2189);  // CRC-16/KERMIT
  const Harvest run = decode("sbg", kRecorded + kNavigation + kUtc + kAnswer + kRecorded);
  EXPECT_EQ(run.totals.frames_ignored, 5U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(Sbg, ReadsWhatAnotherProgramWrites) {
  const Harvest run = decode("sbg", kUtc + kShort);
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(run.samples[0].time.clock_ns, 123'456'000);
  ASSERT_TRUE(run.samples[0].time.utc_ns.has_value());
  EXPECT_EQ(to_iso8601(*run.samples[0].time.utc_ns, 3), "2026-09-19T10:30:15.250Z");
  EXPECT_DOUBLE_EQ(imu[0].temperature_degC, 25.0);
  EXPECT_FALSE(known(imu[0].specific_force_B_m_s2[0]));  // its status says that nothing is well
}

TEST(Sbg, ShortSamplesAreCounts) {
  const auto imu = imu_of(decode("sbg", imu_short(1'000)));
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(imu[0].specific_force_B_m_s2, (std::array<double, 3>{1.0, 0.0, -10.0}));
  EXPECT_EQ(imu[0].angular_rate_B_rad_s, (std::array<double, 3>{1.0, -0.5, 1.0 / 67'108'864.0}));
  EXPECT_DOUBLE_EQ(imu[0].temperature_degC, 25.0);
  EXPECT_FALSE(known(imu[0].delta_time_s));
  EXPECT_FALSE(known(imu[0].delta_angle_B_rad[0]));
  const auto fast = imu_of(decode("sbg", imu_short(1'000, kWell | 0x400, {12'304'174, 0, -492'166'960})));
  ASSERT_EQ(fast.size(), 1U);
  EXPECT_EQ(fast[0].angular_rate_B_rad_s, (std::array<double, 3>{1.0, 0.0, -40.0}));
  EXPECT_EQ(fast[0].specific_force_B_m_s2[2], -10.0);
}

TEST(Sbg, LongSamplesAreInSinglePrecision) {
  const Harvest run = decode("sbg", imu_data(2'000'000));
  const auto imu = imu_of(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(imu[0].specific_force_B_m_s2, (std::array<double, 3>{0.25, -0.125, -9.75}));
  EXPECT_EQ(imu[0].angular_rate_B_rad_s, (std::array<double, 3>{0.5, -0.25, 0.125}));
  EXPECT_DOUBLE_EQ(imu[0].temperature_degC, 31.5);
  EXPECT_EQ(run.samples[0].time.clock_ns, 2 * kNsPerSecond);
  EXPECT_FALSE(run.samples[0].time.utc_ns.has_value());
}

TEST(Sbg, OneOfTheTwoLogsIsEnough) {
  const Harvest both = decode("sbg", imu_short(1'000'000) + imu_data(1'000'000) + imu_short(1'010'000) +
                                         imu_data(1'010'000) + imu_data(2'010'000) + imu_data(2'020'000));
  ASSERT_EQ(both.samples.size(), 3U);  // the last one, more than a second after the last short one, again
  EXPECT_EQ(both.totals.frames_ignored, 3U);
  EXPECT_EQ(both.samples[2].time.clock_ns, 2'020'000'000);
}

TEST(Sbg, StatusDecidesWhichAxesAreKnown) {
  struct Case {
    unsigned cleared;
    std::array<bool, 3> forces;
    std::array<bool, 3> rates;
  };
  constexpr std::array<bool, 3> kAll{true, true, true};
  constexpr std::array<bool, 3> kNone{false, false, false};
  for (const Case& c : {Case{0x000, kAll, kAll},
                        {0x001, kNone, kNone},  // no link to the inertial sensors
                        {0x002, kNone, kNone},  // their test
                        {0x004, {false, true, true}, kAll},
                        {0x008, {true, false, true}, kAll},
                        {0x010, {true, true, false}, kAll},
                        {0x020, kAll, {false, true, true}},
                        {0x0C0, kAll, {true, false, false}},
                        {0x100, kNone, kAll},
                        {0x200, kAll, kNone}}) {
    const auto status = static_cast<std::uint16_t>(kWell & ~c.cleared);
    const auto short_one = imu_of(decode("sbg", imu_short(1'000, status)));
    const auto long_one = imu_of(decode("sbg", imu_data(1'000, status)));
    ASSERT_EQ(short_one.size() + long_one.size(), 2U);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(known(short_one[0].specific_force_B_m_s2[axis]), c.forces[axis]) << c.cleared;
      EXPECT_EQ(known(long_one[0].specific_force_B_m_s2[axis]), c.forces[axis]) << c.cleared;
      EXPECT_EQ(known(short_one[0].angular_rate_B_rad_s[axis]), c.rates[axis]) << c.cleared;
      EXPECT_EQ(known(long_one[0].angular_rate_B_rad_s[axis]), c.rates[axis]) << c.cleared;
    }
  }
}

TEST(Sbg, TheClockGoesOnWhereItsBitsBeginAgain) {
  const Harvest run = decode("sbg", imu_short(0xFFFF'FFF0U) + imu_short(0x0000'2700U) + imu_short(0x26F0U));
  ASSERT_EQ(run.samples.size(), 3U);
  EXPECT_EQ(run.samples[0].time.clock_ns, 4'294'967'280'000);
  EXPECT_EQ(*run.samples[1].time.clock_ns - *run.samples[0].time.clock_ns, 0x2710 * 1'000LL);
  EXPECT_EQ(*run.samples[2].time.clock_ns - *run.samples[1].time.clock_ns, -0x10 * 1'000LL);
}

TEST(Sbg, UtcIsWhatTheUnitKnows) {
  const auto utc_of = [](const ByteVector& before, std::uint32_t stamp_us) {
    return decode("sbg", before + imu_short(stamp_us)).samples.back().time.utc_ns;
  };
  const auto at = [&](std::uint32_t stamp_us) { return utc_of(utc_time(5'000'000), stamp_us); };
  ASSERT_TRUE(at(5'000'000) && at(5'750'000) && at(4'990'000));
  EXPECT_EQ(to_iso8601(*at(5'000'000), 3), "2026-09-19T10:30:15.250Z");
  EXPECT_EQ(to_iso8601(*at(5'750'000), 3), "2026-09-19T10:30:16.000Z");
  EXPECT_EQ(to_iso8601(*at(4'990'000), 3), "2026-09-19T10:30:15.240Z");
  EXPECT_TRUE(at(15'000'000));
  EXPECT_FALSE(at(15'000'001));                                                // too long ago
  for (const std::uint16_t status : {0x0026, 0x0066, 0x00A4, 0x00A2, 0x00A0})  // leap seconds, clock
    EXPECT_FALSE(utc_of(utc_time(5'000'000) + utc_time(5'000'000, status), 5'010'000)) << status;
  EXPECT_TRUE(utc_of(utc_time(5'000'000) + utc_time(5'001'000, 0x00A6, 60), 5'010'000));  // as it was before
  const Harvest wrap = decode("sbg", utc_time(0xFFFF'FFFFU) + imu_short(999'999));
  EXPECT_EQ(to_iso8601(wrap.samples.at(0).time.utc_ns.value(), 3), "2026-09-19T10:30:16.250Z");
}

struct SbgFault {
  const char* name;
  ByteVector bytes;
  RejectReason reason;
};

class SbgFaults : public ::testing::TestWithParam<SbgFault> {};

TEST_P(SbgFaults, AreRefusedOnceAndTheNextFrameIsFound) {
  const Harvest run = decode("sbg", GetParam().bytes + imu_short(9));
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  EXPECT_EQ(run.totals.samples, 1U);
}

ByteVector with(std::size_t from_end, std::uint8_t byte) {
  auto bytes = imu_short(1);
  bytes[bytes.size() - from_end] = byte;
  return bytes;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    All, SbgFaults,
    ::testing::Values(SbgFault{"checksum", with(10, 0x77), RejectReason::checksum},
                      SbgFault{"end", with(1, 0x34), RejectReason::structure},
                      SbgFault{"too_long", {0xFF, 0x5A, 0x2C, 0x00, 0xF7, 0x0F}, RejectReason::length},
                      SbgFault{"short_too_short", frame(44, 0, ByteVector(31, 0)), RejectReason::length},
                      SbgFault{"long_too_short", frame(3, 0, ByteVector(57, 0)), RejectReason::length},
                      SbgFault{"utc_too_short", frame(2, 0, ByteVector(20, 0)), RejectReason::length},
                      SbgFault{"not_a_number", imu_data(1, kWell, kNan), RejectReason::field},
                      SbgFault{"impossible_rate", imu_data(1, kWell, 101.0F), RejectReason::out_of_range},
                      SbgFault{"impossible_force", imu_data(1, kWell, 0.0F, -1'001.0F),
                               RejectReason::out_of_range},
                      SbgFault{"no_temperature", imu_data(1, kWell, 0.0F, 0.0F, kNan), RejectReason::field},
                      SbgFault{"impossible_temperature", imu_data(1, kWell, 0.0F, 0.0F, 300.0F),
                               RejectReason::out_of_range},
                      SbgFault{"month_13", utc_time(1, 0x00A6, 15, 0, 13), RejectReason::out_of_range},
                      SbgFault{"fraction", utc_time(1, 0x00A6, 15, -5), RejectReason::out_of_range}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Sbg, LongerLogsAndOtherFramesDoNotMatter) {
  ByteVector data(48, 0);
  data[4] = 0xFF;
  data[5] = 0x03;
  const Harvest run = decode("sbg", frame(44, 0, data) + frame(44, 1, ByteVector(18, 1)) +  // class 1
                                        frame(44, 0x80, ByteVector(40, 1)) + frame(200, 0, {}) +
                                        frame(31, 0, ByteVector(4'086, 0x5A)));
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.frames_ignored, 4U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  const ByteVector good = imu_short(1);
  const Harvest cut = decode("sbg", ByteVector(good.begin(), good.end() - 3));
  ASSERT_EQ(cut.rejected.size(), 1U);
  EXPECT_EQ(cut.rejected[0].reason, RejectReason::truncated);
}

}  // namespace
}  // namespace fathom::codec::sbg_test

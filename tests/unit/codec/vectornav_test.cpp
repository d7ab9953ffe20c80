#include "codec/imu/vectornav.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "capture.hpp"

namespace fathom::codec::vectornav_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::Harvest;
using capture::of_kind;

/// A frame of any fields: masks by group, then the payload, then the CRC.
ByteVector vectornav_frame(std::uint8_t groups, const std::vector<std::uint16_t>& masks,
                           const ByteVector& payload) {
  ByteVector bytes{0xFA, groups};
  for (const std::uint16_t mask : masks) append_le<std::uint16_t>(bytes, mask);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const std::uint16_t crc = vectornav_crc16(std::span(bytes).subspan(1));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  return bytes;
}

ByteVector floats(const std::vector<float>& values) {
  ByteVector bytes;
  for (const float v : values) append_le<float>(bytes, v);
  return bytes;
}

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ByteVector text(std::string_view t) {
  return {t.begin(), t.end()};
}

const ByteVector kRateAndForce = floats({1, 2, 3, 0.1F, 0.2F, 0.3F});  // group 3: bits 2 and 3
ByteVector good_frame() {
  return vectornav_frame(0x04, {0x000C}, kRateAndForce);
}

TEST(VectorNav, CrcOfAFrameWithItsOwnCrcIsZero) {
  EXPECT_EQ(vectornav_crc16(text("123456789")), 0x31C3);  // the polynomial's published check value
  const auto bytes = good_frame();
  EXPECT_EQ(vectornav_crc16(std::span(bytes).subspan(1)), 0);
}

TEST(VectorNav, ReadsUncompensatedRateAndForce) {
  const Harvest run = decode("vectornav", good_frame());
  const auto imu = of_kind<ImuSample>(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(imu[0].second.specific_force_B_m_s2, (std::array<double, 3>{1, 2, 3}));
  EXPECT_FLOAT_EQ(static_cast<float>(imu[0].second.angular_rate_B_rad_s[2]), 0.3F);
  EXPECT_FALSE(known(imu[0].second.delta_time_s));
  EXPECT_FALSE(imu[0].first->time.clock_ns.has_value());
}

TEST(VectorNav, PrefersUncompensatedToCompensated) {
  // Group 3 bits 2, 3 uncompensated, 9, 10 compensated.
  const auto payload = kRateAndForce + floats({9, 9, 9, 9, 9, 9});
  const Harvest run = decode("vectornav", vectornav_frame(0x04, {0x060C}, payload));
  const auto imu = of_kind<ImuSample>(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(imu[0].second.specific_force_B_m_s2[0], 1.0);
}

TEST(VectorNav, FindsFieldsBehindOthersOfEveryGroup) {
  // Common: startup time and everything of the family; GNSS with satellite list and raw measurements, whose
  // lengths stand inside; attitude and INS.
  ByteVector common;
  append_le<std::uint64_t>(common, 123'456'789'012ULL);
  common.resize(common.size() + 8 + 8 + 12 + 16 + 12 + 24 + 12 + 12, 0);  // bits 1 to 8
  common = common + floats({4, 5, 6, 0.4F, 0.5F, 0.6F});                  // bit 9: force, rate
  common.resize(common.size() + 20 + 28 + 2 + 4 + 8, 0);                  // bits 10 to 14
  ByteVector gnss(8 + 8 + 2 + 1 + 1 + 24 + 24 + 12 + 12 + 12 + 4 + 4 + 2 + 28, 0);
  gnss.push_back(3);  // satellites
  gnss.resize(gnss.size() + 1 + 3 * 8, 0);
  gnss.resize(gnss.size() + 10, 0);
  gnss.push_back(2);  // raw measurements
  gnss.resize(gnss.size() + 1 + 2 * 28, 0);
  const ByteVector attitude(2 + 12 + 16, 0);
  const ByteVector ins(2 + 24, 0);
  const auto bytes = vectornav_frame(0x39, {0x7FFF, 0xFFFF, 0x0007, 0x0003}, common + gnss + attitude + ins);
  const Harvest run = decode("vectornav", bytes);
  const auto imu = of_kind<ImuSample>(run);
  ASSERT_EQ(imu.size(), 1U);
  EXPECT_EQ(imu[0].first->length, bytes.size());
  EXPECT_EQ(imu[0].second.specific_force_B_m_s2, (std::array<double, 3>{4, 5, 6}));
  EXPECT_EQ(imu[0].first->time.clock_ns, 123'456'789'012);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(VectorNav, IncrementsAloneGiveRates) {
  // Common bit 11: interval, angle in degrees, velocity.
  const Harvest run =
      decode("vectornav", vectornav_frame(0x01, {0x0800}, floats({0.01F, 1, 0, -1, 0, 0, -0.098F})));
  const auto imu = of_kind<ImuSample>(run);
  ASSERT_EQ(imu.size(), 1U);
  const ImuSample& s = imu[0].second;
  EXPECT_NEAR(s.delta_time_s, 0.01, 1e-9);
  EXPECT_NEAR(s.delta_angle_B_rad[0], std::numbers::pi / 180.0, 1e-9);
  EXPECT_NEAR(s.angular_rate_B_rad_s[2], -100.0 * std::numbers::pi / 180.0, 1e-5);
  EXPECT_NEAR(s.specific_force_B_m_s2[2], -9.8, 1e-5);
}

TEST(VectorNav, FrameWithoutInertialDataIsIgnored) {
  const Harvest run = decode("vectornav", vectornav_frame(0x10, {0x0002}, floats({10, 20, 30})));
  EXPECT_EQ(run.totals.samples, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
}

TEST(VectorNav, UtcOnlyWhenTheStatusVouchesForIt) {
  for (const std::uint8_t status : {0, 3, 4, 7}) {
    ByteVector payload{26, 1, 31, 12, 30, 15, 250, 0};  // 2026-01-31 12:30:15.250
    payload.push_back(status);
    const Harvest run = decode("vectornav", vectornav_frame(0x06, {0x0240, 0x000C}, payload + kRateAndForce));
    ASSERT_EQ(run.samples.size(), 1U);
    const bool valid = (status & 4) != 0;
    ASSERT_EQ(run.samples[0].time.utc_ns.has_value(), valid);
    if (valid) {
      EXPECT_EQ(to_iso8601(*run.samples[0].time.utc_ns), "2026-01-31T12:30:15.250Z");
    }
  }
}

struct VectornavFault {
  const char* name;
  ByteVector bytes;
  RejectReason reason;
};

class VectorNavFaults : public ::testing::TestWithParam<VectornavFault> {};

TEST_P(VectorNavFaults, AreRefusedOnceAndTheNextFrameIsFound) {
  const Harvest run = decode("vectornav", GetParam().bytes + good_frame());
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  EXPECT_EQ(run.totals.samples, 1U);
}

ByteVector damaged() {
  auto bytes = good_frame();
  bytes[10] ^= 0x40U;
  return bytes;
}

INSTANTIATE_TEST_SUITE_P(
    All, VectorNavFaults,
    ::testing::Values(
        VectornavFault{"checksum", damaged(), RejectReason::checksum},
        VectornavFault{"field_nobody_knows", vectornav_frame(0x04, {0x8000}, {}), RejectReason::structure},
        VectornavFault{"group_nobody_knows", vectornav_frame(0x80, {0x0001}, {}), RejectReason::structure},
        VectornavFault{
            "not_a_number",
            vectornav_frame(0x04, {0x0008}, floats({0, std::numeric_limits<float>::quiet_NaN(), 0})),
            RejectReason::field},
        VectornavFault{
            "infinite",
            vectornav_frame(0x04, {0x0004}, floats({0, 0, std::numeric_limits<float>::infinity()})),
            RejectReason::field},
        VectornavFault{"impossible_rate", vectornav_frame(0x04, {0x0008}, floats({0, 0, 1000})),
                       RejectReason::out_of_range},
        VectornavFault{"text_checksum", text("$VNYMR,1,2,3,4,5,6,7,8,9,1,2,3*00\r\n"),
                       RejectReason::checksum},
        VectornavFault{"text_without_checksum", text("$VNYMR,1,2,3,4,5,6,7,8,9,1,2,3*XX\r\n"),
                       RejectReason::no_checksum},
        VectornavFault{"text_cut", text("$VNYMR,1,2,3\r\n"), RejectReason::structure}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(VectorNav, TextWithEitherChecksum) {
  const std::string body = "VNIMU,+00.1,+00.2,+00.3,-01.5,+02.5,-09.8,+00.01,-00.02,+00.03,+25.0,+101.3";
  std::uint8_t sum = 0;
  for (const char c : body) sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
  std::array<char, 16> digits{};
  for (const bool crc : {false, true}) {
    std::snprintf(digits.data(), digits.size(), crc ? "*%04X\r\n" : "*%02X\r\n",
                  crc ? vectornav_crc16(text(body)) : static_cast<unsigned>(sum));
    const Harvest run = decode("vectornav", text("$" + body + digits.data()));
    const auto imu = of_kind<ImuSample>(run);
    ASSERT_EQ(imu.size(), 1U) << crc;
    EXPECT_DOUBLE_EQ(imu[0].second.specific_force_B_m_s2[2], -9.8);
    EXPECT_DOUBLE_EQ(imu[0].second.angular_rate_B_rad_s[1], -0.02);
    EXPECT_DOUBLE_EQ(imu[0].second.temperature_degC, 25.0);
    EXPECT_EQ(run.totals.skipped_bytes, 0U);
  }
}

TEST(VectorNav, OtherTextIsSkipped) {
  const Harvest run =
      decode("vectornav", text("$GPRMC,,V,,,,,,,,,,N*53\r\n") + good_frame() + text("M,4240\r\n"));
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
}

TEST(VectorNav, CutFrameAtTheEndIsTruncated) {
  auto bytes = good_frame();
  bytes.resize(bytes.size() - 3);
  const Harvest run = decode("vectornav", bytes);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::truncated);
}

}  // namespace
}  // namespace fathom::codec::vectornav_test

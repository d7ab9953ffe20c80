#include "codec/imu/vectornav.hpp"

#include <cmath>
#include <limits>
#include <map>
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
  EXPECT_FALSE(imu[0].first.time.clock_ns.has_value());
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
  EXPECT_EQ(imu[0].first.length, bytes.size());
  EXPECT_EQ(imu[0].second.specific_force_B_m_s2, (std::array<double, 3>{4, 5, 6}));
  EXPECT_EQ(imu[0].first.time.clock_ns, 123'456'789'012);
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

/// Fields of a GNSS group: a good fix off the Korean coast at 2024-06-30 23:59:59.5, which is 86417.5 s of
/// week 2321.
struct Gnss {
  std::uint64_t tow_ns = 86'417'500'000'000;
  std::uint16_t week = 2321;
  std::uint8_t satellites = 11;
  std::uint8_t fix = 3;
  double latitude_deg = -36.4;
  double longitude_deg = 127.4;
  double altitude_m = 18.5;
  std::vector<float> velocity_N_m_s{1.25F, -0.25F, 0.5F};
  std::uint8_t status = 0x07;

  /// In this order the fields 1 to 5, 7, 9, 10, 12 and 13.
  static constexpr std::uint16_t kMask = 0x36BE;
  [[nodiscard]] ByteVector bytes() const {
    ByteVector b;
    append_le<std::uint64_t>(b, tow_ns);
    append_le<std::uint16_t>(b, week);
    b.push_back(satellites);
    b.push_back(fix);
    for (const double v : {latitude_deg, longitude_deg, altitude_m}) append_le<double>(b, v);
    b = b + floats(velocity_N_m_s) + floats({1.5F, 2.0F, 3.0F}) + floats({0.25F}) + ByteVector{status, 18};
    return b + floats({9, 8, 7, 6, 0.75F, 5, 4});
  }
  [[nodiscard]] ByteVector frame() const { return vectornav_frame(0x08, {kMask}, bytes()); }
  [[nodiscard]] ByteVector with_inertial() const {
    return vectornav_frame(0x0C, {0x000C, kMask}, kRateAndForce + bytes());
  }
};

ByteVector infinite_rate_and_fix(const Gnss& gnss) {
  const ByteVector rate = floats({0, 0, std::numeric_limits<float>::infinity()});
  return vectornav_frame(0x0C, {0x0008, Gnss::kMask}, rate + gnss.bytes());
}

TEST(VectorNavFix, ReadsTheGroupOfTheReceiver) {
  const Harvest run = decode("vectornav", Gnss{}.frame());
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(to_iso8601(*run.samples[0].time.utc_ns), "2024-06-30T23:59:59.500Z");
  EXPECT_FALSE(run.samples[0].time.clock_ns.has_value());
  const auto& s = std::get<GpsSample>(run.samples[0].sample);
  EXPECT_EQ(s.fix, GpsFix::fix_3d);
  EXPECT_EQ(s.satellites, 11);
  EXPECT_DOUBLE_EQ(s.latitude_rad, -36.4 * std::numbers::pi / 180.0);
  EXPECT_DOUBLE_EQ(s.longitude_rad, 127.4 * std::numbers::pi / 180.0);
  EXPECT_EQ(s.altitude_m, 18.5);
  EXPECT_FALSE(known(s.altitude_msl_m));
  EXPECT_EQ(s.velocity_N_m_s, (std::array<double, 3>{1.25, -0.25, 0.5}));
  EXPECT_EQ(s.position_sigma_N_m, (std::array<double, 3>{1.5, 2.0, 3.0}));
  EXPECT_EQ(s.velocity_sigma_N_m_s, (std::array<double, 3>{0.25, 0.25, 0.25}));
  EXPECT_EQ(s.hdop, 0.75);
}

TEST(VectorNavFix, FixKinds) {
  const std::map<std::uint8_t, GpsFix> kinds{
      {0, GpsFix::none},         {1, GpsFix::time_only}, {2, GpsFix::fix_2d},   {3, GpsFix::fix_3d},
      {4, GpsFix::differential}, {7, GpsFix::rtk_float}, {8, GpsFix::rtk_fixed}};
  for (const auto& [code, kind] : kinds) {
    const auto fixes = of_kind<GpsSample>(decode("vectornav", Gnss{.fix = code}.frame()));
    ASSERT_EQ(fixes.size(), 1U) << int{code};
    EXPECT_EQ(fixes[0].second.fix, kind) << int{code};
    EXPECT_EQ(known(fixes[0].second.latitude_rad), code >= 2) << int{code};
    EXPECT_EQ(known(fixes[0].second.velocity_N_m_s[0]), code >= 2) << int{code};
    EXPECT_EQ(fixes[0].second.satellites, 11) << int{code};
  }
}

TEST(VectorNavFix, InertialDataComesFirstAndARepeatedFixOnce) {
  Gnss gnss;
  ByteVector stream = gnss.with_inertial() + gnss.with_inertial() + gnss.frame();
  gnss.tow_ns += 200'000'000;
  stream = stream + gnss.with_inertial();
  const Harvest run = decode("vectornav", stream);
  std::vector<std::size_t> kinds;
  for (const Decoded& decoded : run.samples) kinds.push_back(decoded.sample.index());
  const std::size_t imu = AnySample(ImuSample{}).index();
  const std::size_t gps = AnySample(GpsSample{}).index();
  EXPECT_EQ(kinds, (std::vector<std::size_t>{imu, gps, imu, imu, gps}));
  EXPECT_EQ(run.totals.frames_ignored, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(VectorNavFix, ALostFixIsSaidThoughItsTimeStandsStill) {
  const Harvest run = decode("vectornav", Gnss{}.frame() + Gnss{.fix = 0}.frame() + Gnss{.fix = 0}.frame());
  const auto fixes = of_kind<GpsSample>(run);
  ASSERT_EQ(fixes.size(), 2U);
  EXPECT_EQ(fixes[1].second.fix, GpsFix::none);
}

/// Fields 3 to 5 and 7: nothing that says when.
ByteVector timeless(double latitude_deg) {
  ByteVector b{11, 3};
  for (const double v : {latitude_deg, 127.4, 18.5}) append_le<double>(b, v);
  return vectornav_frame(0x08, {0x00B8}, b + floats({1, 2, 3}));
}

TEST(VectorNavFix, WithoutTowTimeUtcOrTheValuesTellANewOne) {
  const Harvest run = decode("vectornav", timeless(36.4) + timeless(36.4) + timeless(36.5));
  EXPECT_EQ(of_kind<GpsSample>(run).size(), 2U);
  EXPECT_EQ(run.totals.frames_ignored, 1U);

  const auto with_utc = [](std::uint8_t second) {  // fields 0, 4 and 7; half a second less by its fraction
    const ByteVector utc{24, 6, 30, 23, 59, second, 0x0C, 0xFE};
    return vectornav_frame(0x08, {0x0091}, utc + ByteVector{3} + floats({1, 2, 3}));
  };
  const Harvest dated = decode("vectornav", with_utc(58) + with_utc(58) + with_utc(59));
  ASSERT_EQ(dated.samples.size(), 2U);
  EXPECT_EQ(to_iso8601(*dated.samples[1].time.utc_ns), "2024-06-30T23:59:58.500Z");
  EXPECT_FALSE(known(std::get<GpsSample>(dated.samples[1].sample).latitude_rad));
}

TEST(VectorNavFix, FramesThatTellLessOfItAddNone) {
  Gnss gnss;
  ByteVector stream;
  for (int i = 0; i < 3; ++i) {
    stream = stream + gnss.frame() + timeless(-36.4);
    gnss.tow_ns += 200'000'000;
  }
  EXPECT_EQ(decode("vectornav", stream).totals.samples, 3U);
}

TEST(VectorNavFix, TheSecondAntennaCountsOnlyWithoutTheFirst) {
  const Gnss first;
  const Gnss second{.latitude_deg = -36.5};
  const ByteVector alone = vectornav_frame(0x40, {Gnss::kMask}, second.bytes());
  const ByteVector both = vectornav_frame(0x48, {Gnss::kMask, Gnss::kMask}, first.bytes() + second.bytes());
  EXPECT_EQ(of_kind<GpsSample>(decode("vectornav", alone)).size(), 1U);
  const auto fixes = of_kind<GpsSample>(decode("vectornav", alone + both + alone));
  ASSERT_EQ(fixes.size(), 2U);
  EXPECT_DOUBLE_EQ(fixes[1].second.latitude_rad, -36.4 * std::numbers::pi / 180.0);
}

TEST(VectorNavFix, TimeOnlyWhereTimeInfoVouchesForIt) {
  for (const std::uint8_t status : {0, 1, 2, 3, 4, 7}) {
    const Harvest run = decode("vectornav", Gnss{.status = status}.frame());
    ASSERT_EQ(run.samples.size(), 1U);
    EXPECT_EQ(run.samples[0].time.utc_ns.has_value(), (status & 3) == 3) << int{status};
  }
}

TEST(VectorNavFix, GroupsWithoutFixOrWithNeitherPositionNorVelocityAreIgnored) {
  ByteVector position;
  for (const double v : {36.4, 127.4, 18.5}) append_le<double>(position, v);
  const Harvest run = decode(
      "vectornav", vectornav_frame(0x08, {0x0020}, position) + vectornav_frame(0x08, {0x0018}, {11, 3}));
  EXPECT_EQ(run.totals.samples, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 2U);
}

TEST(VectorNavFix, AnImpossibleOneIsRefusedOnceAndIsNoneBesideGoodInertialData) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<Gnss, RejectReason>> faults{
      {{.latitude_deg = 90.5}, RejectReason::out_of_range},
      {{.longitude_deg = -180.5}, RejectReason::out_of_range},
      {{.altitude_m = nan}, RejectReason::field},
      {{.velocity_N_m_s = {0, std::numeric_limits<float>::infinity(), 0}}, RejectReason::field},
      {{.fix = 5}, RejectReason::field},
      {{.tow_ns = 604'800'000'000'001}, RejectReason::out_of_range},
      {{.week = 0xFFFF}, RejectReason::out_of_range}};
  for (const auto& [gnss, reason] : faults) {
    const Harvest alone = decode("vectornav", gnss.frame() + gnss.frame());
    EXPECT_EQ(alone.totals.samples, 0U);
    ASSERT_EQ(alone.rejected.size(), 1U);
    EXPECT_EQ(alone.rejected[0].reason, reason);
    EXPECT_EQ(alone.totals.frames_ignored, 1U);

    const Harvest kept = decode("vectornav", gnss.with_inertial());
    EXPECT_EQ(of_kind<ImuSample>(kept).size(), 1U);
    const auto fixes = of_kind<GpsSample>(kept);
    ASSERT_EQ(fixes.size(), 1U);
    EXPECT_EQ(fixes[0].second.fix, GpsFix::none) << "which is seen";
    EXPECT_FALSE(known(fixes[0].second.latitude_rad));
    EXPECT_EQ(kept.totals.rejected, 0U);
  }
}

TEST(VectorNavFix, IsKeptWhereTheInertialDataCannotBe) {
  const Harvest run = decode("vectornav", infinite_rate_and_fix({}) + infinite_rate_and_fix({}));
  EXPECT_EQ(of_kind<GpsSample>(run).size(), 1U);
  EXPECT_EQ(run.totals.samples, 1U);
  ASSERT_EQ(run.rejected.size(), 1U);  // the second one, which has no new fix
  EXPECT_EQ(run.rejected[0].reason, RejectReason::field);
}

TEST(VectorNavFix, AnAccuracyThatIsNoneIsUnknown) {
  ByteVector b{3};
  for (const double v : {36.4, 127.4, 18.5}) append_le<double>(b, v);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto fixes =
      of_kind<GpsSample>(decode("vectornav", vectornav_frame(0x08, {0x0230}, b + floats({0.0F, nan, 2.0F}))));
  ASSERT_EQ(fixes.size(), 1U);
  EXPECT_FALSE(known(fixes[0].second.position_sigma_N_m[0]));
  EXPECT_FALSE(known(fixes[0].second.position_sigma_N_m[1]));
  EXPECT_EQ(fixes[0].second.position_sigma_N_m[2], 2.0);
  EXPECT_FALSE(known(fixes[0].second.velocity_N_m_s[0]));
  EXPECT_EQ(fixes[0].second.satellites, -1);
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

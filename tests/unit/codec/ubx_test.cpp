#include "codec/ubx.hpp"

#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

#include <gtest/gtest.h>

#include "codec/bytes.hpp"
#include "support/codec/decode_run.hpp"

namespace fathom::codec {
namespace {

using test::ByteVector;
using test::decode_whole;
using test::DecodeRun;

constexpr double kDegree = std::numbers::pi / 180.0;

template <class T>
void put(ByteVector& bytes, std::size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof(T));
}

ByteVector frame(std::uint8_t message_class, std::uint8_t id, const ByteVector& payload) {
  ByteVector bytes;
  bytes.reserve(payload.size() + 8);
  for (const std::uint8_t byte : {kUbxSync1, kUbxSync2, message_class, id}) bytes.push_back(byte);
  append_le<std::uint16_t>(bytes, static_cast<std::uint16_t>(payload.size()));
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  const auto [a, b] = ubx_checksum(Bytes(bytes).subspan(2));
  bytes.push_back(a);
  bytes.push_back(b);
  return bytes;
}

/// A good three-dimensional fix off the Korean coast.
ByteVector pvt(std::size_t length = 92) {
  ByteVector p(length, 0);
  put<std::uint16_t>(p, 4, 2024);
  p[6] = 6;
  p[7] = 30;
  p[8] = 23;
  p[9] = 59;
  p[10] = 59;
  p[11] = 0x07;
  put<std::int32_t>(p, 16, 500'000'000);
  p[20] = 3;
  p[21] = 0x01;
  p[23] = 11;
  put<std::int32_t>(p, 24, 1'274'000'000);
  put<std::int32_t>(p, 28, -364'000'000);
  put<std::int32_t>(p, 32, 18'500);
  put<std::int32_t>(p, 36, -7'250);
  put<std::uint32_t>(p, 40, 1'500);
  put<std::uint32_t>(p, 44, 2'500);
  put<std::int32_t>(p, 48, 1'250);
  put<std::int32_t>(p, 52, -250);
  put<std::int32_t>(p, 56, 12);
  put<std::int32_t>(p, 64, 34'869'000);
  put<std::uint32_t>(p, 68, 90);
  return p;
}

GpsSample decode_pvt(const ByteVector& payload) {
  const DecodeRun run = decode_whole("ubx", frame(0x01, 0x07, payload));
  EXPECT_EQ(run.samples.size(), 1U);
  return run.samples.empty() ? GpsSample{} : std::get<GpsSample>(run.samples[0].sample);
}

std::optional<TimeNs> time_of(const ByteVector& payload) {
  const DecodeRun run = decode_whole("ubx", frame(0x01, 0x07, payload));
  EXPECT_EQ(run.samples.size(), 1U);
  return run.samples.empty() ? std::nullopt : run.samples[0].time.utc_ns;
}

RejectReason refused(const ByteVector& bytes) {
  const DecodeRun run = decode_whole("ubx", bytes);
  EXPECT_EQ(run.rejected.size(), 1U);
  EXPECT_TRUE(run.samples.empty());
  return run.rejected.empty() ? RejectReason::truncated : run.rejected[0].reason;
}

TEST(UbxNavPvt, UnitsAndAccuracies) {
  for (const std::size_t length : {std::size_t{92}, std::size_t{84}}) {
    const GpsSample gps = decode_pvt(pvt(length));
    EXPECT_EQ(gps.fix, GpsFix::fix_3d);
    EXPECT_EQ(gps.satellites, 11);
    EXPECT_NEAR(gps.latitude_rad, -36.4 * kDegree, 1e-12);
    EXPECT_NEAR(gps.longitude_rad, 127.4 * kDegree, 1e-12);
    EXPECT_DOUBLE_EQ(gps.altitude_m, 18.5);
    EXPECT_DOUBLE_EQ(gps.altitude_msl_m, -7.25);
    EXPECT_NEAR(gps.position_sigma_N_m[0], 1.5 / std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(gps.position_sigma_N_m[1], 1.5 / std::numbers::sqrt2, 1e-12);
    EXPECT_DOUBLE_EQ(gps.position_sigma_N_m[2], 2.5);
    EXPECT_DOUBLE_EQ(gps.velocity_N_m_s[0], 1.25);
    EXPECT_DOUBLE_EQ(gps.velocity_N_m_s[1], -0.25);
    EXPECT_DOUBLE_EQ(gps.velocity_N_m_s[2], 0.012);
    EXPECT_DOUBLE_EQ(gps.velocity_sigma_N_m_s[2], 0.09);
    EXPECT_NEAR(gps.course_rad, 348.69 * kDegree, 1e-9);
  }
}

TEST(UbxNavPvt, NegativeNanosecondsAreAddedToTheSecond) {
  ByteVector p = pvt();
  EXPECT_EQ(time_of(p), *from_civil({.year = 2024,
                                     .month = 6,
                                     .day = 30,
                                     .hour = 23,
                                     .minute = 59,
                                     .second = 59,
                                     .nanosecond = 500'000'000}));
  const TimeNs full = *time_of(p) - 500'000'000;
  put<std::int32_t>(p, 16, -123);
  EXPECT_EQ(time_of(p), full - 123);
}

TEST(UbxNavPvt, TimeOnlyWhenFullyResolved) {
  for (const std::uint8_t valid : {0x00, 0x01, 0x02, 0x03, 0x05, 0x06}) {
    ByteVector p = pvt();
    p[11] = valid;
    EXPECT_FALSE(time_of(p).has_value()) << int{valid};
  }
}

TEST(UbxNavPvt, FixKinds) {
  struct Case {
    std::uint8_t type;
    std::uint8_t flags;
    GpsFix fix;
  };
  for (const Case& c :
       {Case{0, 0x01, GpsFix::none}, Case{1, 0x01, GpsFix::dead_reckoning}, Case{2, 0x01, GpsFix::fix_2d},
        Case{3, 0x01, GpsFix::fix_3d}, Case{4, 0x01, GpsFix::fix_3d}, Case{5, 0x01, GpsFix::time_only},
        Case{3, 0x03, GpsFix::differential}, Case{3, 0x43, GpsFix::rtk_float},
        Case{4, 0x83, GpsFix::rtk_fixed}, Case{3, 0x00, GpsFix::none}, Case{3, 0x82, GpsFix::none}}) {
    ByteVector p = pvt();
    p[20] = c.type;
    p[21] = c.flags;
    const GpsSample gps = decode_pvt(p);
    EXPECT_EQ(gps.fix, c.fix) << int{c.type} << " " << int{c.flags};
    EXPECT_EQ(known(gps.latitude_rad), c.fix >= GpsFix::dead_reckoning);
    EXPECT_EQ(known(gps.velocity_N_m_s[0]), c.fix >= GpsFix::dead_reckoning);
  }
}

TEST(UbxNavPvt, APositionMarkedInvalidIsNone) {
  ByteVector p = pvt();
  p[78] = 0x01;
  EXPECT_EQ(decode_pvt(p).fix, GpsFix::none);
  ByteVector old = pvt(84);
  old[78] = 0x01;  // reserved in that generation
  EXPECT_EQ(decode_pvt(old).fix, GpsFix::fix_3d);
}

TEST(UbxNavPvt, ContradictionsAreRefused) {
  ByteVector p = pvt();
  p[20] = 6;
  EXPECT_EQ(refused(frame(0x01, 0x07, p)), RejectReason::field);
  p = pvt();
  p[6] = 13;
  EXPECT_EQ(refused(frame(0x01, 0x07, p)), RejectReason::out_of_range);
  p = pvt();
  put<std::int32_t>(p, 28, 900'000'001);
  EXPECT_EQ(refused(frame(0x01, 0x07, p)), RejectReason::out_of_range);
  EXPECT_EQ(refused(frame(0x01, 0x07, ByteVector(60, 0))), RejectReason::length);
}

TEST(Ubx, AFlippedBitAnywhereIsRefused) {
  const ByteVector good = frame(0x01, 0x07, pvt());
  for (std::size_t i = 6; i < good.size(); ++i) {
    ByteVector bad = good;
    bad[i] ^= 0x10;
    EXPECT_EQ(refused(bad), RejectReason::checksum) << i;
  }
}

TEST(Ubx, AnImpossibleLengthIsRefusedWithoutWaitingForIt) {
  auto codec = find_protocol("ubx")->make({});
  DecodeRun run;
  codec->feed(ByteVector{kUbxSync1, kUbxSync2, 0x01, 0x07, 0xFF, 0xFF}, run);
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::length);
}

TEST(Ubx, ACorruptLengthDoesNotSwallowTheFramesBehindIt) {
  ByteVector stream = frame(0x01, 0x07, pvt());
  stream[4] = 0xF0;  // 240 instead of 92
  const ByteVector good = frame(0x01, 0x07, pvt());
  for (int i = 0; i < 4; ++i) stream.insert(stream.end(), good.begin(), good.end());
  const DecodeRun run = decode_whole("ubx", stream);
  EXPECT_EQ(run.samples.size(), 4U);
  EXPECT_EQ(run.rejected.size(), 1U);
}

TEST(Ubx, OtherMessagesAndPollsCarryNoSample) {
  ByteVector stream = frame(0x01, 0x35, ByteVector(20, 1));
  const ByteVector poll = frame(0x01, 0x07, {});
  stream.insert(stream.end(), poll.begin(), poll.end());
  const DecodeRun run = decode_whole("ubx", stream);
  EXPECT_TRUE(run.samples.empty());
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.frames_ignored, 2U);
}

TEST(Ubx, NmeaAndCorrectionsInBetweenAreSkipped) {
  ByteVector stream = test::bytes_of("$GPHDT,25.50,T*37\r\n");
  const ByteVector good = frame(0x01, 0x07, pvt());
  stream.insert(stream.end(), good.begin(), good.end());
  for (const std::uint8_t byte : {0xD3, 0x00, 0x04, 0xB5, 0x4C, 0xE0, 0x00}) stream.push_back(byte);
  stream.insert(stream.end(), good.begin(), good.end());
  const DecodeRun run = decode_whole("ubx", stream);
  EXPECT_EQ(run.samples.size(), 2U);
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.skipped_bytes, 19U + 7U);
  EXPECT_EQ(decode_whole("nmea0183", stream).samples.size(), 1U);
}

}  // namespace
}  // namespace fathom::codec

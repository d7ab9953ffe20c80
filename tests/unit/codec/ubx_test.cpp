#include "codec/satellite/ubx.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/fletcher.hpp"
#include "codec/satellite/ubx_interference.hpp"
#include "support/codec/decode_run.hpp"

namespace fathom::codec {
namespace {

using test::ByteVector;
using test::decode_whole;
using test::DecodeRun;

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
  const auto [a, b] = fletcher8(Bytes(bytes).subspan(2));
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
    EXPECT_NEAR(gps.latitude_rad, -36.4 * kRadPerDeg, 1e-12);
    EXPECT_NEAR(gps.longitude_rad, 127.4 * kRadPerDeg, 1e-12);
    EXPECT_DOUBLE_EQ(gps.altitude_m, 18.5);
    EXPECT_DOUBLE_EQ(gps.altitude_msl_m, -7.25);
    EXPECT_NEAR(gps.position_sigma_N_m[0], 1.5 / std::numbers::sqrt2, 1e-12);
    EXPECT_NEAR(gps.position_sigma_N_m[1], 1.5 / std::numbers::sqrt2, 1e-12);
    EXPECT_DOUBLE_EQ(gps.position_sigma_N_m[2], 2.5);
    EXPECT_DOUBLE_EQ(gps.velocity_N_m_s[0], 1.25);
    EXPECT_DOUBLE_EQ(gps.velocity_N_m_s[1], -0.25);
    EXPECT_DOUBLE_EQ(gps.velocity_N_m_s[2], 0.012);
    EXPECT_DOUBLE_EQ(gps.velocity_sigma_N_m_s[2], 0.09);
    EXPECT_NEAR(gps.course_rad, 348.69 * kRadPerDeg, 1e-9);
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

ByteVector nav_status(unsigned spoofing_state) {
  ByteVector p(16, 0);
  p[7] = static_cast<std::uint8_t>(spoofing_state << 3U | 0x02U);
  return frame(0x01, 0x03, p);
}
ByteVector mon_hw(unsigned jamming_state, std::size_t length = 60) {
  ByteVector p(length, 0xFF);
  p[22] = static_cast<std::uint8_t>(0xF3U | jamming_state << 2U);
  return frame(0x0A, 0x09, p);
}
ByteVector mon_rf(const std::vector<unsigned>& jamming_states) {
  ByteVector p(4 + 24 * jamming_states.size(), 0);
  p[1] = static_cast<std::uint8_t>(jamming_states.size());
  for (std::size_t i = 0; i < jamming_states.size(); ++i) {
    p[4 + 24 * i + 1] = static_cast<std::uint8_t>(jamming_states[i]);
  }
  return frame(0x0A, 0x38, p);
}
ByteVector sec_sig_1(std::uint8_t jamming_flags, std::uint8_t spoofing_flags) {
  ByteVector p(12, 0);
  p[0] = 1;
  p[4] = jamming_flags;
  p[8] = spoofing_flags;
  return frame(0x27, 0x09, p);
}
ByteVector sec_sig_2(std::uint8_t flags, std::size_t bands) {
  ByteVector p(4 + 4 * bands, 0);
  p[0] = 2;
  p[1] = flags;
  p[3] = static_cast<std::uint8_t>(bands);
  return frame(0x27, 0x09, p);
}

/// The fix that follows these messages.
GpsSample fix_after(const std::vector<ByteVector>& messages, int fixes = 1) {
  ByteVector stream;
  for (const ByteVector& message : messages) stream.insert(stream.end(), message.begin(), message.end());
  const ByteVector fix = frame(0x01, 0x07, pvt());
  for (int i = 0; i < fixes; ++i) stream.insert(stream.end(), fix.begin(), fix.end());
  const DecodeRun run = decode_whole("ubx", stream);
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.samples.size(), static_cast<std::size_t>(fixes));
  return run.samples.empty() ? GpsSample{} : std::get<GpsSample>(run.samples.back().sample);
}

TEST(Ubx, JammingAndSpoofingAreUnknownWhereNothingSaysThem) {
  const GpsSample fix = fix_after({});
  EXPECT_EQ(fix.jamming, GpsJamming::unknown);
  EXPECT_EQ(fix.spoofing, GpsSpoofing::unknown);
}

TEST(Ubx, EveryMessageThatSpeaksOfInterferenceIsHeard) {
  constexpr std::array kJamming{GpsJamming::unknown, GpsJamming::none, GpsJamming::warning,
                                GpsJamming::critical};
  constexpr std::array kSpoofing{GpsSpoofing::unknown, GpsSpoofing::none, GpsSpoofing::indicated,
                                 GpsSpoofing::affirmed};
  for (unsigned state = 0; state < 4; ++state) {
    const auto on = [state](unsigned shift) { return static_cast<std::uint8_t>(state << shift | 1U); };
    EXPECT_EQ(fix_after({nav_status(state)}).spoofing, kSpoofing.at(state));
    EXPECT_EQ(fix_after({mon_hw(state)}).jamming, kJamming.at(state));
    EXPECT_EQ(fix_after({mon_hw(state, 68)}).jamming, kJamming.at(state));
    EXPECT_EQ(fix_after({mon_rf({0, state})}).jamming, kJamming.at(state));
    EXPECT_EQ(fix_after({sec_sig_1(on(1), 0)}).jamming, kJamming.at(state));
    EXPECT_EQ(fix_after({sec_sig_1(0, on(1))}).spoofing, kSpoofing.at(state));
    EXPECT_EQ(fix_after({sec_sig_2(on(1), 3)}).jamming, kJamming.at(state));
    EXPECT_EQ(fix_after({sec_sig_2(static_cast<std::uint8_t>(state << 4U | 8U), 0)}).spoofing,
              kSpoofing.at(state));
  }
}

TEST(Ubx, OfSeveralWordsOnInterferenceTheWorstCounts) {
  const GpsSample fix = fix_after({mon_hw(3), mon_rf({1, 1}), nav_status(1), sec_sig_1(0x03, 0x05)});
  EXPECT_EQ(fix.jamming, GpsJamming::critical);
  EXPECT_EQ(fix.spoofing, GpsSpoofing::indicated);
  EXPECT_EQ(fix_after({mon_hw(3), mon_hw(1)}).jamming, GpsJamming::none) << "a newer one replaces it";
}

TEST(Ubx, ADetectionThatIsOffSaysNothing) {
  const GpsSample fix = fix_after({sec_sig_1(0x06, 0x06), sec_sig_2(0x36, 0)});
  EXPECT_EQ(fix.jamming, GpsJamming::unknown);
  EXPECT_EQ(fix.spoofing, GpsSpoofing::unknown);
}

TEST(Ubx, AWordOnInterferenceDoesNotHoldForEver) {
  EXPECT_EQ(fix_after({mon_rf({2})}, UbxInterference::kFixesHeld).jamming, GpsJamming::warning);
  EXPECT_EQ(fix_after({mon_rf({2})}, UbxInterference::kFixesHeld + 1).jamming, GpsJamming::unknown);
}

TEST(Ubx, DamagedWordsOnInterferenceAreRefused) {
  const std::vector<ByteVector> damaged{
      frame(0x01, 0x03, ByteVector(15, 0)), frame(0x0A, 0x09, ByteVector(59, 0)),
      frame(0x0A, 0x38, ByteVector{0, 2, 0, 0}), frame(0x27, 0x09, ByteVector(13, 1)),
      frame(0x27, 0x09, ByteVector{2, 0, 0, 9})};
  for (const ByteVector& bytes : damaged) {
    const DecodeRun run = decode_whole("ubx", bytes);
    ASSERT_EQ(run.rejected.size(), 1U);
    EXPECT_EQ(run.rejected[0].reason, RejectReason::length);
  }
  const DecodeRun reserved = decode_whole("ubx", sec_sig_1(0, 0x0F));  // spoofing state 7
  ASSERT_EQ(reserved.rejected.size(), 1U);
  EXPECT_EQ(reserved.rejected[0].reason, RejectReason::field);
  EXPECT_TRUE(decode_whole("ubx", frame(0x27, 0x09, ByteVector(40, 9))).rejected.empty())
      << "of a later version";
}

}  // namespace
}  // namespace fathom::codec

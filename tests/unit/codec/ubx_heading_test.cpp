// NAV-RELPOSNED: messages laid by hand.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "codec/fletcher.hpp"
#include "codec/satellite/ubx.hpp"
#include "support/codec/decode_run.hpp"

namespace fathom::codec::ubx_heading_test {
namespace {

using test::ByteVector;
using test::decode_whole;
using test::DecodeRun;

constexpr std::uint32_t kGood = 0x0137;  // fix, corrected, valid, carrier phase fixed, moving base, heading
constexpr std::uint32_t kMovingBit = 0x20;
constexpr std::uint32_t kTow_ms = 86'399'000;

struct Relposned {
  std::uint8_t version = 1;
  std::uint32_t tow_ms = kTow_ms;
  std::int32_t heading_1e5_deg = 27'050'000;
  std::uint32_t accuracy_1e5_deg = 35'000;
  std::uint32_t flags = kGood;
  std::size_t length = 64;
};

ByteVector ubx_message(std::uint8_t id, const ByteVector& payload) {
  ByteVector out{0xB5, 0x62, 0x01, id};
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(payload.size()));
  out.insert(out.end(), payload.begin(), payload.end());
  const auto [a, b] = fletcher8(Bytes(out).subspan(2));
  out.push_back(a);
  out.push_back(b);
  return out;
}

ByteVector relposned(const Relposned& m = {}) {
  ByteVector p(64, 0);
  p[0] = m.version;
  store_le<std::uint32_t>(p, 4, m.tow_ms);
  store_le<std::int32_t>(p, 8, 1);     // north, cm
  store_le<std::int32_t>(p, 12, -99);  // east
  store_le<std::uint32_t>(p, 20, 99);
  store_le<std::int32_t>(p, 24, m.heading_1e5_deg);
  store_le<std::uint32_t>(p, 52, m.accuracy_1e5_deg);
  store_le<std::uint32_t>(p, 60, m.flags);
  p.resize(m.length, 0);
  return ubx_message(0x3C, p);
}

/// A solution of 2024-06-30 23:59:42 UTC.
ByteVector solution(std::uint32_t tow_ms, std::uint8_t valid = 0x07) {
  ByteVector p(92, 0);
  store_le<std::uint32_t>(p, 0, tow_ms);
  store_le<std::uint16_t>(p, 4, 2024);
  p[6] = 6;
  p[7] = 30;
  p[8] = 23;
  p[9] = 59;
  p[10] = 42;
  p[11] = valid;
  return ubx_message(0x07, p);
}

std::vector<HeadingSample> headings(const DecodeRun& run) {
  std::vector<HeadingSample> out;
  for (const Decoded& each : run.samples) {
    if (const auto* heading = std::get_if<HeadingSample>(&each.sample)) out.push_back(*heading);
  }
  return out;
}

TEST(UbxRelposned, AMovingBaseGivesATrueHeading) {
  const auto got = headings(decode_whole("ubx", relposned()));
  ASSERT_EQ(got.size(), 1U);
  EXPECT_EQ(got[0].north, North::true_north);
  EXPECT_NEAR(got[0].heading_rad, 270.5 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(got[0].sigma_rad, 0.35 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(headings(decode_whole("ubx", relposned({.heading_1e5_deg = -9'000'000}))).at(0).heading_rad,
              270.0 * kRadPerDeg, 1e-12);
  EXPECT_LT(headings(decode_whole("ubx", relposned({.heading_1e5_deg = 36'000'000}))).at(0).heading_rad,
            1e-12);
  EXPECT_TRUE(std::isnan(headings(decode_whole("ubx", relposned({.accuracy_1e5_deg = 0}))).at(0).sigma_rad));
}

TEST(UbxRelposned, WhatTheReceiverDoesNotVouchForIsUnknown) {
  for (const std::uint32_t without : {0x01U, 0x04U, 0x10U, 0x100U}) {
    const auto got = headings(decode_whole("ubx", relposned({.flags = kGood & ~without})));
    ASSERT_EQ(got.size(), 1U) << without;
    EXPECT_TRUE(std::isnan(got[0].heading_rad)) << without;
  }
  const auto floating = headings(decode_whole("ubx", relposned({.flags = (kGood & ~0x10U) | 0x08U})));
  EXPECT_TRUE(std::isnan(floating.at(0).heading_rad)) << "the carrier phase is not fixed";
}

TEST(UbxRelposned, ABaselineToTheShoreIsNoHeading) {
  for (const Relposned& other :
       {Relposned{.flags = kGood & ~kMovingBit}, Relposned{.version = 0, .length = 40}}) {
    const DecodeRun run = decode_whole("ubx", relposned(other));
    EXPECT_TRUE(run.samples.empty());
    EXPECT_TRUE(run.rejected.empty());
    EXPECT_EQ(run.totals.frames_ignored, 1U);
  }
}

TEST(UbxRelposned, ImpossibleOnesAreRefused) {
  const auto reason = [](const Relposned& message) {
    const DecodeRun run = decode_whole("ubx", relposned(message));
    EXPECT_TRUE(run.samples.empty());
    return run.rejected.size() == 1 ? run.rejected[0].reason : RejectReason::truncated;
  };
  EXPECT_EQ(reason({.heading_1e5_deg = 36'000'100}), RejectReason::out_of_range);
  EXPECT_EQ(reason({.length = 60}), RejectReason::length);
}

TEST(UbxRelposned, UtcComesFromTheSolutionBefore) {
  const auto utc_after = [](const ByteVector& before, std::uint32_t tow_ms) -> std::optional<TimeNs> {
    ByteVector stream = before;
    const ByteVector message = relposned({.tow_ms = tow_ms});
    stream.insert(stream.end(), message.begin(), message.end());
    const DecodeRun run = decode_whole("ubx", stream);
    return run.samples.back().time.utc_ns;
  };
  const TimeNs utc_ns =
      *from_civil({.year = 2024, .month = 6, .day = 30, .hour = 23, .minute = 59, .second = 42});
  EXPECT_EQ(utc_after(solution(kTow_ms), kTow_ms), utc_ns);
  EXPECT_EQ(utc_after(solution(kTow_ms), kTow_ms + 125), utc_ns + 125 * kNsPerMillisecond);
  EXPECT_EQ(utc_after(solution(604'799'900), 25), utc_ns + 125 * kNsPerMillisecond) << "over the week's end";
  EXPECT_EQ(utc_after(solution(25), 604'799'900), utc_ns - 125 * kNsPerMillisecond);
  EXPECT_FALSE(utc_after(solution(kTow_ms), kTow_ms + 11'000)) << "the solution is too old";
  EXPECT_FALSE(utc_after(solution(kTow_ms, 0x03), kTow_ms)) << "its UTC was not resolved";
  EXPECT_FALSE(utc_after({}, kTow_ms));
}

}  // namespace
}  // namespace fathom::codec::ubx_heading_test

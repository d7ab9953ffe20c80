// The satellite receivers of SBG units: logs laid by hand.
#include <cmath>
#include <limits>
#include <span>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "capture.hpp"
#include "codec/imu/sbg.hpp"
#include "fault.hpp"

namespace fathom::codec::sbg_gnss_test {
namespace {

using capture::ByteVector;
using capture::decode;
using capture::expect_refused_once;
using capture::Fault;
using capture::Harvest;
using capture::name_of_fault;
using capture::of_kind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kTow_ms = 556'233'250;  // 2026-09-19 10:30:15.25, a Saturday
constexpr std::uint8_t kVelocity1 = 13;
constexpr std::uint8_t kPosition1 = 14;
constexpr std::uint8_t kHeading1 = 15;
constexpr std::uint8_t kVelocity2 = 16;
constexpr std::uint8_t kPosition2 = 17;
constexpr std::uint8_t kHeading2 = 18;

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

ByteVector frame(std::uint8_t message, const ByteVector& data) {
  ByteVector out{0xFF, 0x5A, message, 0};
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  out = out + data;
  append_le<std::uint16_t>(out, sbg::crc16(std::span(out).subspan(2)));
  out.push_back(0x33);
  return out;
}

struct Log {
  std::uint32_t tow_ms = kTow_ms;
  std::uint32_t status = 2U << 6U;
  std::uint32_t stamp_us = 5'000'000;
  double latitude_deg = -36.5;
  double longitude_deg = 127.25;
  double height_msl_m = 18.25;
  float undulation_m = 26.0F;
  float sigma = 1.5F;
  std::uint8_t satellites = 17;
  std::uint32_t interference = 0x0122;
  std::size_t size = 62;
};

ByteVector position(const Log& p = {}, std::uint8_t message = kPosition1) {
  ByteVector data;
  for (const std::uint32_t word : {p.stamp_us, p.status, p.tow_ms}) append_le<std::uint32_t>(data, word);
  for (const double v : {p.latitude_deg, p.longitude_deg, p.height_msl_m}) append_le<double>(data, v);
  for (const float v : {p.undulation_m, p.sigma, 2.5F, 3.5F}) append_le<float>(data, v);
  data = data + ByteVector{p.satellites, 0xFF, 0xFF, 0xFF, 0xFF, 30};
  append_le<std::uint32_t>(data, p.interference);
  data.resize(p.size);
  return frame(message, data);
}

ByteVector velocity(std::uint32_t tow_ms = kTow_ms, std::uint32_t status = 2U << 6U, float north = 1.5F,
                    float course_deg = 341.5F, std::uint8_t message = kVelocity1) {
  ByteVector data;
  for (const std::uint32_t word : {std::uint32_t{5'000'100}, status, tow_ms})
    append_le<std::uint32_t>(data, word);
  for (const float v : {north, -0.5F, 0.25F, 0.125F, 0.25F, 0.5F, course_deg, 2.0F})
    append_le<float>(data, v);
  return frame(message, data);
}

struct HeadingLog {
  std::uint16_t status = 0x40;  // the length of the line is valid
  std::uint32_t tow_ms = kTow_ms;
  std::uint32_t stamp_us = 5'000'000;
  float heading_deg = 271.5F;
  float sigma_deg = 0.25F;
  std::size_t size = 32;
};

ByteVector heading(const HeadingLog& h = {}, std::uint8_t message = kHeading1) {
  ByteVector data;
  append_le<std::uint32_t>(data, h.stamp_us);
  append_le<std::uint16_t>(data, h.status);
  append_le<std::uint32_t>(data, h.tow_ms);
  for (const float v : {h.heading_deg, h.sigma_deg, -1.5F, 0.5F, 2.0F}) append_le<float>(data, v);
  data = data + ByteVector{20, 18};
  data.resize(h.size);
  return frame(message, data);
}

/// 2026-09-19 10:30:15 and a fraction at the stamp.
ByteVector utc_time(std::uint32_t stamp_us = 5'000'000, std::uint32_t tow_ms = kTow_ms,
                    std::int32_t nanosecond = 250'000'000, std::uint16_t status = 0x00A6) {
  ByteVector data;
  append_le<std::uint32_t>(data, stamp_us);
  append_le<std::uint16_t>(data, status);
  append_le<std::uint16_t>(data, 2026);
  data = data + ByteVector{9, 19, 10, 30, 15};
  append_le<std::int32_t>(data, nanosecond);
  append_le<std::uint32_t>(data, tow_ms);
  return frame(2, data);
}

std::vector<std::pair<Decoded, GpsSample>> fixes(const ByteVector& bytes) {
  return of_kind<GpsSample>(decode("sbg", bytes));
}

std::vector<std::pair<Decoded, HeadingSample>> headings(const ByteVector& bytes) {
  return of_kind<HeadingSample>(decode("sbg", bytes));
}

bool moves(const std::pair<Decoded, GpsSample>& fix) {
  return known(fix.second.velocity_N_m_s[0]);
}

TEST(SbgGnss, PositionAndVelocityOfATimeAreOneFix) {
  const Harvest run = decode("sbg", utc_time() + velocity() + position());
  ASSERT_EQ(run.samples.size(), 1U);
  const auto& s = std::get<GpsSample>(run.samples[0].sample);
  EXPECT_EQ(s.fix, GpsFix::fix_3d);
  EXPECT_EQ(s.satellites, 17);
  EXPECT_DOUBLE_EQ(s.latitude_rad, -36.5 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(s.longitude_rad, 127.25 * kRadPerDeg);
  EXPECT_EQ(s.altitude_msl_m, 18.25);
  EXPECT_EQ(s.altitude_m, 44.25);
  EXPECT_EQ(s.position_sigma_N_m, (std::array<double, 3>{1.5, 2.5, 3.5}));
  EXPECT_EQ(s.velocity_N_m_s, (std::array<double, 3>{1.5, -0.5, 0.25}));
  EXPECT_EQ(s.velocity_sigma_N_m_s, (std::array<double, 3>{0.125, 0.25, 0.5}));
  EXPECT_DOUBLE_EQ(s.course_rad, 341.5 * kRadPerDeg);
  EXPECT_EQ(s.jamming, GpsJamming::none);
  EXPECT_EQ(s.spoofing, GpsSpoofing::none);
  EXPECT_EQ(run.samples[0].time.clock_ns, 5 * kNsPerSecond);
  EXPECT_EQ(to_iso8601(run.samples[0].time.utc_ns.value(), 3), "2026-09-19T10:30:15.250Z");
  EXPECT_EQ(run.totals.frames_ignored, 2U);  // the velocity as well, while it waited
  EXPECT_EQ(run.totals.rejected + run.totals.skipped_bytes, 0U);
}

TEST(SbgGnss, StatusAndTypeSayWhatTheFixIs) {
  struct Case {
    std::uint32_t status;
    GpsFix fix;
  };
  for (const Case& c : {Case{0U << 6U, GpsFix::none},
                        {1U << 6U, GpsFix::none},
                        {2U << 6U, GpsFix::fix_3d},
                        {3U << 6U, GpsFix::differential},
                        {4U << 6U, GpsFix::differential},
                        {5U << 6U, GpsFix::differential},
                        {6U << 6U, GpsFix::rtk_float},
                        {7U << 6U | 0x3FFF'F000U, GpsFix::rtk_fixed},  // and the signals that it uses
                        {8U << 6U, GpsFix::differential},
                        {9U << 6U, GpsFix::differential},
                        {10U << 6U, GpsFix::dead_reckoning},
                        {2U << 6U | 1U, GpsFix::none},  // not computed
                        {2U << 6U | 3U, GpsFix::none}}) {
    const auto found = fixes(velocity() + position({.status = c.status}));
    ASSERT_EQ(found.size(), 1U) << c.status;
    const bool fixed = c.fix != GpsFix::none;
    EXPECT_EQ(found[0].second.fix, c.fix) << c.status;
    EXPECT_EQ(known(found[0].second.latitude_rad), fixed) << c.status;
    EXPECT_EQ(moves(found[0]), fixed) << c.status;
    EXPECT_EQ(found[0].second.satellites, 17);
  }
  for (const std::uint32_t status : {0U, 1U << 6U, 2U << 6U | 1U})
    EXPECT_FALSE(moves(fixes(velocity(kTow_ms, status, kNanF) + position()).at(0))) << status;
  EXPECT_TRUE(moves(fixes(velocity(kTow_ms, 3U << 6U) + position()).at(0)));
  EXPECT_FALSE(known(fixes(velocity(kTow_ms, 2U << 6U, 0.0F, kNanF) + position())[0].second.course_rad));
  const auto empty = fixes(utc_time() + position({.tow_ms = 0xFFFF'FFFF, .status = 1, .latitude_deg = kNan}));
  ASSERT_EQ(empty.size(), 1U);  // a receiver without sky is heard
  EXPECT_FALSE(empty[0].first.time.utc_ns.has_value());
}

TEST(SbgGnss, OlderFirmwareSaysLess) {
  const auto old = fixes(position({.size = 52}));
  ASSERT_EQ(old.size(), 1U);
  EXPECT_EQ(old[0].second.satellites, -1);
  EXPECT_EQ(old[0].second.fix, GpsFix::fix_3d);
  EXPECT_EQ(fixes(position({.size = 57})).at(0).second.satellites, 17);
  EXPECT_EQ(fixes(position({.size = 57})).at(0).second.jamming, GpsJamming::unknown);
  EXPECT_EQ(fixes(position({.satellites = 0xFF})).at(0).second.satellites, -1);
}

TEST(SbgGnss, InterferenceIsWhatTheReceiverSays) {
  const auto told = [](std::uint32_t state) {
    const auto found = fixes(position({.interference = state}));
    return std::pair(found.at(0).second.jamming, found.at(0).second.spoofing);
  };
  EXPECT_EQ(told(0x00), std::pair(GpsJamming::unknown, GpsSpoofing::unknown));
  EXPECT_EQ(told(0x11), std::pair(GpsJamming::unknown, GpsSpoofing::unknown));
  EXPECT_EQ(told(0x33), std::pair(GpsJamming::warning, GpsSpoofing::indicated));
  EXPECT_EQ(told(0x44), std::pair(GpsJamming::critical, GpsSpoofing::affirmed));
  EXPECT_EQ(told(0xFF), std::pair(GpsJamming::unknown, GpsSpoofing::unknown));
}

TEST(SbgGnss, WhetherAVelocityFollowsIsLearned) {
  ByteVector stream;
  for (std::uint32_t i = 0; i < 3; ++i) stream = stream + position({.tow_ms = i}) + velocity(i);
  const auto found = fixes(stream);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_FALSE(moves(found[0]));  // delivered at once: nobody knew
  EXPECT_TRUE(moves(found[1]) && moves(found[2]));

  const std::size_t one = position().size();
  const Harvest lonely =
      decode("sbg", stream + position({.tow_ms = 3}) + position({.tow_ms = 4}) + position({.tow_ms = 5}));
  ASSERT_EQ(lonely.samples.size(), 6U);  // two have waited in vain, the last one does not wait
  EXPECT_EQ(lonely.samples[3].offset, stream.size());
  EXPECT_EQ(lonely.samples[5].offset, stream.size() + 2 * one);
  const auto again = fixes(stream + position({.tow_ms = 3}) + position({.tow_ms = 4}) + velocity(4));
  ASSERT_EQ(again.size(), 5U);  // one velocity lost: the next position waits all the same
  EXPECT_FALSE(moves(again[3]));
  EXPECT_TRUE(moves(again[4]));
}

TEST(SbgGnss, PositionsAloneAreHeardAtOnceAndOthersVelocitiesNotJoined) {
  const auto codec = find_protocol("sbg")->make({});
  struct Count final : Sink {
    void on_sample(const Decoded&) override { ++samples; }
    void on_rejected(const Rejected&) override {}
    int samples = 0;
  } sink;
  for (std::uint32_t i = 0; i < 3; ++i) {
    codec->feed(position({.tow_ms = i}), sink);
    EXPECT_EQ(sink.samples, static_cast<int>(i) + 1);
  }
  const auto found = fixes(velocity(1) + position({.tow_ms = 2}) + position({.tow_ms = 3}) + velocity(7));
  ASSERT_EQ(found.size(), 2U);
  EXPECT_FALSE(moves(found[0]) || moves(found[1]));
  EXPECT_EQ(decode("sbg", velocity(1) + velocity(2)).totals.frames_ignored, 2U);
  // A position that waits at the end of the stream is not lost.
  EXPECT_EQ(fixes(position({.tow_ms = 1}) + velocity(1) + position({.tow_ms = 2})).size(), 2U);
}

TEST(SbgGnss, UtcIsThatOfTheTimeOfTheWeek) {
  const auto utc = [](const ByteVector& bytes) { return fixes(bytes).at(0).first.time.utc_ns; };
  const auto text = [&](const ByteVector& bytes) { return to_iso8601(utc(bytes).value(), 3); };
  // The stamp is a little off; the time of the week decides.
  const Log later{.tow_ms = kTow_ms + 200, .stamp_us = 5'203'000};
  EXPECT_EQ(text(utc_time() + position(later)), "2026-09-19T10:30:15.450Z");
  // A fraction that whole milliseconds do not hold.
  EXPECT_EQ(utc(utc_time(5'000'000, kTow_ms, 250'400'000) + position()).value() % kNsPerSecond, 250'000'000);
  EXPECT_EQ(utc(utc_time(5'000'000, kTow_ms + 749, 999'999'900) +
                position({.tow_ms = kTow_ms + 750, .stamp_us = 5'000'001}))
                    .value() %
                kNsPerSecond,
            0);
  // The week ends between the two.
  EXPECT_EQ(text(utc_time(5'000'000, 604'799'250) + position({.tow_ms = 50, .stamp_us = 5'800'000})),
            "2026-09-19T10:30:16.050Z");
  EXPECT_FALSE(utc(position()));                                            // no UTC_TIME
  EXPECT_FALSE(utc(utc_time(5'000'000, kTow_ms, 0, 0x0026) + position()));  // not initialized
  EXPECT_FALSE(utc(utc_time() + position({.stamp_us = 15'000'001})));       // too long ago
  EXPECT_FALSE(utc(utc_time() + position({.tow_ms = kTow_ms + 5'000})));    // contradicts the stamp
}

TEST(SbgGnss, TheSecondReceiverCountsWhereThereIsNoOther) {
  const auto second = [](std::uint32_t tow_ms) {
    return velocity(tow_ms, 2U << 6U, 9.0F, 0.0F, kVelocity2) +
           position({.tow_ms = tow_ms, .satellites = 2}, kPosition2);
  };
  const auto alone = fixes(second(1) + second(2) + second(3));
  ASSERT_EQ(alone.size(), 2U);
  EXPECT_TRUE(moves(alone[0]) && moves(alone[1]));
  const auto both = fixes(second(1) + velocity(1) + position({.tow_ms = 1}) + second(2) + velocity(2) +
                          position({.tow_ms = 2}));
  ASSERT_EQ(both.size(), 2U);
  for (const auto& [decoded, s] : both) {
    EXPECT_EQ(s.satellites, 17);
    EXPECT_EQ(s.velocity_N_m_s[0], 1.5);
  }
}

TEST(SbgGnss, TwoAntennasGiveAHeading) {
  // 5 s, solution, 556233250 ms, 271.5 and 0.25 deg, -1.5 and 0.5 deg; no more than the first firmware said.
  const ByteVector data{0x40, 0x4B, 0x4C, 0x00, 0x00, 0x00, 0x22, 0x72, 0x27, 0x21, 0x00, 0xC0, 0x87,
                        0x43, 0x00, 0x00, 0x80, 0x3E, 0x00, 0x00, 0xC0, 0xBF, 0x00, 0x00, 0x00, 0x3F};
  for (const ByteVector& log : {frame(15, data), heading(), heading({.size = 30}), heading({.size = 40})}) {
    const Harvest run = decode("sbg", utc_time() + log);
    ASSERT_EQ(run.samples.size(), 1U) << log.size();
    const auto& s = std::get<HeadingSample>(run.samples[0].sample);
    EXPECT_EQ(s.north, North::true_north);
    EXPECT_DOUBLE_EQ(s.heading_rad, 271.5 * kRadPerDeg);
    EXPECT_DOUBLE_EQ(s.sigma_rad, 0.25 * kRadPerDeg);
    EXPECT_FALSE(known(s.variation_rad) || known(s.deviation_rad));
    EXPECT_EQ(run.samples[0].time.clock_ns, 5 * kNsPerSecond);
    EXPECT_EQ(to_iso8601(run.samples[0].time.utc_ns.value(), 3), "2026-09-19T10:30:15.250Z");
    EXPECT_EQ(run.samples[0].length, log.size());
    EXPECT_EQ(run.totals.rejected + run.totals.skipped_bytes, 0U);
  }
  EXPECT_EQ(headings(heading({.heading_deg = 0.0F})).at(0).second.heading_rad, 0.0);
  EXPECT_EQ(headings(heading({.heading_deg = 360.0F})).at(0).second.heading_rad, 0.0);
  const Log later{.tow_ms = kTow_ms + 200, .stamp_us = 5'203'000};
  EXPECT_EQ(headings(utc_time() + heading({.tow_ms = later.tow_ms, .stamp_us = later.stamp_us}))
                .at(0)
                .first.time.utc_ns,
            fixes(utc_time() + position(later)).at(0).first.time.utc_ns);
  EXPECT_FALSE(headings(heading()).at(0).first.time.utc_ns.has_value());
}

TEST(SbgGnss, AHeadingWithoutSolutionIsUnknown) {
  for (const std::uint16_t status : {1, 2, 3, 63, 0x41})
    for (const float heading_deg : {271.5F, 999.0F, kNanF}) {
      const auto found = headings(
          utc_time() + heading({.status = status, .tow_ms = 0xFFFF'FFFF, .heading_deg = heading_deg}));
      ASSERT_EQ(found.size(), 1U) << status;
      EXPECT_FALSE(known(found[0].second.heading_rad) || known(found[0].second.sigma_rad)) << status;
      EXPECT_EQ(found[0].first.time.clock_ns, 5 * kNsPerSecond);
      EXPECT_FALSE(found[0].first.time.utc_ns.has_value());
    }
  for (const float sigma_deg : {0.0F, -1.0F, kNanF}) {
    const auto found = headings(heading({.sigma_deg = sigma_deg}));
    ASSERT_EQ(found.size(), 1U) << sigma_deg;
    EXPECT_TRUE(known(found[0].second.heading_rad)) << sigma_deg;
    EXPECT_FALSE(known(found[0].second.sigma_rad)) << sigma_deg;
  }
  for (const float sigma_deg : {180.0F, 360.0F, std::numeric_limits<float>::infinity()})
    EXPECT_FALSE(known(headings(heading({.sigma_deg = sigma_deg})).at(0).second.heading_rad)) << sigma_deg;
}

TEST(SbgGnss, TheSecondReceiversHeadingCountsWhereThereIsNoOther) {
  const ByteVector second = heading({.heading_deg = 10.0F}, kHeading2);
  // Fixes of the first receiver do not silence it.
  EXPECT_EQ(headings(position() + second + second + position() + second).size(), 2U);
  const auto both = headings(second + heading() + second + heading({.status = 1}) + second);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_DOUBLE_EQ(both[0].second.heading_rad, 271.5 * kRadPerDeg);
  EXPECT_FALSE(known(both[1].second.heading_rad));
}

class SbgGnssFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(SbgGnssFaults, AreRefusedOnceAndTheNextFrameIsFound) {
  expect_refused_once("sbg", GetParam(), position());
}

constexpr auto kOutside = RejectReason::out_of_range;

INSTANTIATE_TEST_SUITE_P(
    All, SbgGnssFaults,
    ::testing::Values(Fault{"latitude", position({.latitude_deg = -90.5}), kOutside},
                      Fault{"longitude", position({.longitude_deg = 181.0}), kOutside},
                      Fault{"longitude_no_number", position({.longitude_deg = kNan}), RejectReason::field},
                      Fault{"height", position({.height_msl_m = -2e5}), kOutside},
                      Fault{"undulation", position({.undulation_m = kNanF}), RejectReason::field},
                      Fault{"negative_accuracy", position({.sigma = -1.0F}), kOutside},
                      Fault{"type", position({.status = 11U << 6U}), RejectReason::field},
                      Fault{"time_of_the_week", position({.tow_ms = 604'800'000}), kOutside},
                      Fault{"position_cut", position({.size = 51}), RejectReason::length},
                      Fault{"heading_beyond", heading({.heading_deg = 360.5F}), kOutside},
                      Fault{"heading_negative", heading({.heading_deg = -0.5F}), kOutside},
                      Fault{"heading_no_number", heading({.heading_deg = kNanF}), RejectReason::field},
                      Fault{"heading_time_of_the_week", heading({.tow_ms = 604'800'000}), kOutside},
                      Fault{"heading_cut", heading({.size = 25}), RejectReason::length},
                      Fault{"heading_of_the_second", heading({.heading_deg = 361.0F}, kHeading2), kOutside},
                      Fault{"velocity_cut", frame(kVelocity1, ByteVector(43, 0)), RejectReason::length},
                      Fault{"velocity_type", velocity(kTow_ms, 4U << 6U), RejectReason::field},
                      Fault{"velocity_no_number", velocity(kTow_ms, 2U << 6U, kNanF), RejectReason::field},
                      Fault{"velocity", velocity(kTow_ms, 2U << 6U, 2e4F), kOutside},
                      Fault{"course", velocity(kTow_ms, 2U << 6U, 0.0F, 720.0F), kOutside}),
    name_of_fault);

}  // namespace
}  // namespace fathom::codec::sbg_gnss_test

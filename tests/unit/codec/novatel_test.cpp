// NovAtel binary logs: published frames, and logs laid by hand.
#include "codec/satellite/novatel/novatel.hpp"

#include <cmath>
#include <limits>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "base/bytes/little_endian.hpp"
#include "base/units.hpp"
#include "capture.hpp"
#include "fault.hpp"
#include "support/paths.hpp"

namespace fathom::codec::novatel_test {
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
constexpr std::uint16_t kPositionLog = 42;
constexpr std::uint16_t kVelocityLog = 99;
constexpr std::uint16_t kTimeLog = 101;
constexpr std::uint16_t kHeading2 = 1335;
constexpr std::uint16_t kDualAntenna = 2042;

ByteVector operator+(ByteVector a, const ByteVector& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

struct Head {
  std::uint32_t tow_ms = 336'803'000;
  std::uint16_t week = 2164;
  std::uint8_t type = 0;
  std::uint8_t status = 180;
  std::uint8_t length = 28;
};

ByteVector log(std::uint16_t message, const ByteVector& data, const Head& h = {}) {
  ByteVector out{0xAA, 0x44, 0x12, h.length};
  append_le<std::uint16_t>(out, message);
  out = out + ByteVector{h.type, 0x20};
  append_le<std::uint16_t>(out, static_cast<std::uint16_t>(data.size()));
  out = out + ByteVector{0, 0, 155, h.status};
  append_le<std::uint16_t>(out, h.week);
  append_le<std::uint32_t>(out, h.tow_ms);
  out.resize(h.length, 0x5A);
  out = out + data;
  append_le<std::uint32_t>(out, novatel::crc32(out));
  return out;
}

struct Place {
  Head head{};
  std::uint32_t status = 0;
  std::uint32_t type = 16;
  double latitude_deg = -36.5;
  double longitude_deg = 127.25;
  double height_msl_m = 18.25;
  float undulation_m = 26.0F;
  std::uint32_t datum = 61;
  float sigma_m = 1.5F;
  std::size_t size = 72;
};

ByteVector position(const Place& p = {}) {
  ByteVector data;
  for (const std::uint32_t word : {p.status, p.type}) append_le<std::uint32_t>(data, word);
  for (const double v : {p.latitude_deg, p.longitude_deg, p.height_msl_m}) append_le<double>(data, v);
  append_le<float>(data, p.undulation_m);
  append_le<std::uint32_t>(data, p.datum);
  for (const float v : {p.sigma_m, 2.5F, 3.5F}) append_le<float>(data, v);
  data = data + ByteVector{'R', '2', '2', '2'};
  for (const float v : {0.5F, 0.0F}) append_le<float>(data, v);
  data = data + ByteVector{30, 17, 16, 15, 0, 0x06, 0x11, 0x33};
  data.resize(p.size);
  return log(kPositionLog, data, p.head);
}

struct Speed {
  Head head{};
  std::uint32_t status = 0;
  std::uint32_t type = 8;
  float latency_s = 0.0F;
  double speed_m_s = 2.0;
  double track_deg = 120.0;
  double up_m_s = 0.25;
  std::size_t size = 44;
};

ByteVector velocity(const Speed& v = {}) {
  ByteVector data;
  for (const std::uint32_t word : {v.status, v.type}) append_le<std::uint32_t>(data, word);
  for (const float each : {v.latency_s, 1.0F}) append_le<float>(data, each);
  for (const double each : {v.speed_m_s, v.track_deg, v.up_m_s}) append_le<double>(data, each);
  append_le<float>(data, 0.0F);
  data.resize(v.size);
  return log(kVelocityLog, data, v.head);
}

struct Line {
  Head head{};
  std::uint32_t status = 0;
  std::uint32_t type = 50;
  float length_m = 0.927607417F;
  float heading_deg = 178.347869873F;
  float pitch_deg = -1.3037414550F;
  float sigma_deg = 0.261901051F;
  std::size_t size = 44;
};

ByteVector heading(const Line& l = {}, std::uint16_t message = kDualAntenna) {
  ByteVector data;
  for (const std::uint32_t word : {l.status, l.type}) append_le<std::uint32_t>(data, word);
  for (const float each : {l.length_m, l.heading_deg, l.pitch_deg, 0.0F, l.sigma_deg, 0.391376048F})
    append_le<float>(data, each);
  data = data + ByteVector{'R', '2', '2', '2', 18, 17, 17, 16, 0x04, 0x01, 0, 0x33};
  data.resize(l.size);
  return log(message, data, l.head);
}

ByteVector time_log(double utc_less_gps_s, std::uint32_t utc_status = 1, std::size_t size = 44) {
  ByteVector data;
  append_le<std::uint32_t>(data, 0);
  for (const double v : {1e-9, 2e-9, utc_less_gps_s}) append_le<double>(data, v);
  append_le<std::uint32_t>(data, 2021);
  data = data + ByteVector{6, 30, 21, 33};
  append_le<std::uint32_t>(data, 5'000);
  append_le<std::uint32_t>(data, utc_status);
  data.resize(size);
  return log(kTimeLog, data);
}

std::vector<std::pair<Decoded, GpsSample>> fixes(const ByteVector& bytes) {
  return of_kind<GpsSample>(decode("novatel", bytes));
}
std::vector<std::pair<Decoded, HeadingSample>> headings(const ByteVector& bytes) {
  return of_kind<HeadingSample>(decode("novatel", bytes));
}

bool moves(const std::pair<Decoded, GpsSample>& fix) {
  return known(fix.second.velocity_N_m_s[0]);
}

/// From the maker's manual (section 32-bit CRC), the tests of a decoder of a compatible receiver's logs,
/// those of a vehicle's driver, and twice the tests of the maker's own decoder.
ByteVector published() {
  return capture::load(test::vectors_dir() + "/novatel/published.bin");
}

TEST(Novatel, PublishedFramesAreReadAsOthersReadThem) {
  const Harvest run = decode("novatel", published());
  EXPECT_EQ(run.totals.rejected + run.totals.skipped_bytes, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 2U) << "BESTVEL of another time, and inertial data";
  ASSERT_EQ(run.samples.size(), 3U);
  const auto& first = std::get<GpsSample>(run.samples[0].sample);
  EXPECT_EQ(first.fix, GpsFix::fix_3d);
  EXPECT_EQ(first.satellites, 11);
  EXPECT_NEAR(first.latitude_rad, 51.11678162962945 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(first.longitude_rad, -114.03886375946635 * kRadPerDeg, 1e-15);
  EXPECT_NEAR(first.altitude_msl_m, 1063.8170145507902, 1e-9);
  EXPECT_NEAR(first.altitude_m, 1063.8170145507902 - 16.270824432373047, 1e-9);
  EXPECT_NEAR(first.position_sigma_N_m[0], 1.5887, 5e-5);
  EXPECT_NEAR(first.position_sigma_N_m[2], 3.0063, 5e-5);
  EXPECT_FALSE(moves({run.samples[0], first}));
  EXPECT_EQ(std::get<GpsSample>(run.samples[1].sample).satellites, 24);
  EXPECT_EQ(to_iso8601(run.samples[1].time.utc_ns.value(), 0), "2021-06-30T21:33:05Z");
  // Of a log from 2007 the receiver has to say how many leap seconds there were.
  const auto then = fixes(time_log(-14.0) + published());
  EXPECT_EQ(to_iso8601(then.at(0).first.time.utc_ns.value(), 0), "2007-05-16T15:15:44Z");
}

TEST(Novatel, APublishedVelocityIsThatOfItsTime) {
  const ByteVector all = published();
  const ByteVector bestvel(all.begin() + 104, all.begin() + 180);
  const auto found = fixes(bestvel + position({.head = {.tow_ms = 558'924'650, .week = 2437}}));
  ASSERT_EQ(found.size(), 1U);
  const GpsSample& s = found[0].second;
  EXPECT_NEAR(std::hypot(s.velocity_N_m_s[0], s.velocity_N_m_s[1]), 0.0018505971628139163, 1e-15);
  EXPECT_NEAR(s.course_rad, 289.11935882406186 * kRadPerDeg, 1e-12);
  EXPECT_DOUBLE_EQ(s.velocity_N_m_s[2], -0.0015534800508009666);
  EXPECT_LT(s.velocity_N_m_s[1], 0.0) << "to the west";
}

TEST(Novatel, PositionAndVelocityOfATimeAreOneFix) {
  const Harvest run = decode("novatel", velocity() + position());
  ASSERT_EQ(run.samples.size(), 1U);
  const auto& s = std::get<GpsSample>(run.samples[0].sample);
  EXPECT_EQ(s.fix, GpsFix::fix_3d);
  EXPECT_EQ(s.satellites, 17);
  EXPECT_DOUBLE_EQ(s.latitude_rad, -36.5 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(s.longitude_rad, 127.25 * kRadPerDeg);
  EXPECT_EQ(s.altitude_msl_m, 18.25);
  EXPECT_EQ(s.altitude_m, 44.25);
  EXPECT_EQ(s.position_sigma_N_m, (std::array<double, 3>{1.5, 2.5, 3.5}));
  EXPECT_NEAR(s.velocity_N_m_s[0], -1.0, 1e-12);
  EXPECT_NEAR(s.velocity_N_m_s[1], std::sqrt(3.0), 1e-12);
  EXPECT_EQ(s.velocity_N_m_s[2], -0.25);
  EXPECT_DOUBLE_EQ(s.course_rad, 120.0 * kRadPerDeg);
  EXPECT_FALSE(known(s.velocity_sigma_N_m_s[0]));
  EXPECT_EQ(run.samples[0].offset, velocity().size());
  EXPECT_EQ(run.samples[0].length, position().size());
  EXPECT_EQ(to_iso8601(run.samples[0].time.utc_ns.value(), 0), "2021-06-30T21:33:05Z");
}

TEST(Novatel, EachFixIsDeliveredOnceAndWaitsForNoLogThatDoesNotCome) {
  const auto at = [](std::uint32_t tow_ms) { return Head{.tow_ms = tow_ms}; };
  ByteVector stream;
  for (std::uint32_t i = 0; i < 3; ++i)
    stream = stream + position({.head = at(i)}) + velocity({.head = at(i)});
  const auto found = fixes(stream);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_FALSE(moves(found[0]));  // delivered at once: nobody knew
  EXPECT_TRUE(moves(found[1]) && moves(found[2]));
  ByteVector alone = stream;
  for (std::uint32_t i = 3; i < 6; ++i) alone = alone + position({.head = at(i)});
  EXPECT_EQ(fixes(alone).size(), 6U);
  // The velocity of another time is not joined, and without a position it is no sample.
  const auto other = fixes(velocity({.head = at(1)}) + position({.head = at(2)}));
  ASSERT_EQ(other.size(), 1U);
  EXPECT_FALSE(moves(other[0]));
  EXPECT_TRUE(fixes(velocity()).empty());
}

TEST(Novatel, StatusAndTypeSayWhatTheFixIs) {
  struct Case {
    std::uint32_t type;
    GpsFix fix;
  };
  for (const Case& c : {Case{0, GpsFix::none},
                        Case{1, GpsFix::dead_reckoning},
                        Case{2, GpsFix::fix_2d},
                        Case{16, GpsFix::fix_3d},
                        Case{17, GpsFix::differential},
                        Case{18, GpsFix::differential},
                        Case{19, GpsFix::dead_reckoning},
                        Case{32, GpsFix::rtk_float},
                        Case{34, GpsFix::rtk_float},
                        Case{48, GpsFix::rtk_fixed},
                        Case{49, GpsFix::rtk_fixed},
                        Case{50, GpsFix::rtk_fixed},
                        Case{51, GpsFix::rtk_fixed},
                        Case{53, GpsFix::fix_3d},
                        Case{54, GpsFix::differential},
                        Case{55, GpsFix::rtk_float},
                        Case{56, GpsFix::rtk_fixed},
                        Case{68, GpsFix::differential},
                        Case{69, GpsFix::differential},
                        Case{71, GpsFix::fix_3d},
                        Case{74, GpsFix::differential},
                        Case{78, GpsFix::differential}}) {
    const auto found = fixes(velocity() + position({.type = c.type}));
    ASSERT_EQ(found.size(), 1U) << c.type;
    const bool fixed = c.fix != GpsFix::none;
    EXPECT_EQ(found[0].second.fix, c.fix) << c.type;
    EXPECT_EQ(known(found[0].second.latitude_rad), fixed) << c.type;
    EXPECT_EQ(moves(found[0]), fixed) << c.type;
  }
  for (const std::uint32_t status : {1U, 2U, 4U, 6U, 13U, 18U, 19U, 99U}) {
    const auto found =
        fixes(velocity() + position({.status = status, .type = 50, .latitude_deg = kNan, .datum = 0}));
    ASSERT_EQ(found.size(), 1U) << "a receiver without sky is heard";
    EXPECT_EQ(found[0].second.fix, GpsFix::none) << status;
    EXPECT_FALSE(known(found[0].second.latitude_rad) || moves(found[0])) << status;
    EXPECT_TRUE(found[0].first.time.utc_ns.has_value());
  }
}

TEST(Novatel, AVelocityThatIsNoneOrOldIsUnknown) {
  const auto moves_with = [](const Speed& v) { return moves(fixes(velocity(v) + position()).at(0)); };
  EXPECT_FALSE(moves_with({.status = 1, .speed_m_s = kNan}));
  EXPECT_FALSE(moves_with({.type = 0}));
  EXPECT_TRUE(moves_with({.type = 56}));
  EXPECT_TRUE(moves_with({.latency_s = 0.05F}));
  EXPECT_TRUE(moves_with({.latency_s = 0.15F}));
  EXPECT_FALSE(moves_with({.latency_s = 0.25F})) << "the mean of half a second";
  EXPECT_DOUBLE_EQ(fixes(velocity({.track_deg = -90.0}) + position()).at(0).second.course_rad,
                   270.0 * kRadPerDeg);
}

TEST(Novatel, WeekAndTimeAreUtcWhereTheReceiverKnowsThem) {
  const auto utc = [](const ByteVector& bytes) { return fixes(bytes).at(0).first.time.utc_ns; };
  const auto knows = [&](std::uint8_t status) {
    return utc(position({.head = {.status = status}})).has_value();
  };
  for (const int status : {100, 120, 130, 140, 160, 170, 180, 240})
    EXPECT_TRUE(knows(static_cast<std::uint8_t>(status))) << status;
  for (const int status : {0, 20, 60, 80, 181, 200, 220})
    EXPECT_FALSE(knows(static_cast<std::uint8_t>(status))) << status;
  const TimeNs by_default_ns = utc(position()).value();
  EXPECT_EQ(utc(time_log(-17.0) + position()).value() - by_default_ns, kNsPerSecond);
  for (const std::uint32_t doubtful : {0U, 2U})
    EXPECT_EQ(utc(time_log(-17.0, doubtful) + position()), by_default_ns) << doubtful;
  // A time that nobody vouches for may be anything.
  EXPECT_EQ(fixes(position({.head = {.tow_ms = 0xFFFF'FFFF, .status = 20}})).size(), 1U);
}

TEST(Novatel, TwoAntennasGiveAHeading) {
  for (const ByteVector& one : {heading({.size = 48}, kHeading2), heading(), heading({.size = 52})}) {
    const Harvest run = decode("novatel", one);
    ASSERT_EQ(run.samples.size(), 1U);
    const auto& s = std::get<HeadingSample>(run.samples[0].sample);
    EXPECT_EQ(s.north, North::true_north);
    EXPECT_NEAR(s.heading_rad, 178.347869873 * kRadPerDeg, 1e-6);
    EXPECT_NEAR(s.sigma_rad, 0.261901051 * kRadPerDeg, 1e-9);
    EXPECT_EQ(to_iso8601(run.samples[0].time.utc_ns.value(), 0), "2021-06-30T21:33:05Z");
  }
  // The manual's example of DUALANTENNAHEADING does not say how long the line is.
  const Line example{.length_m = -1.0F, .heading_deg = 255.538528442F, .pitch_deg = 0.006041416F};
  EXPECT_NEAR(headings(heading(example)).at(0).second.heading_rad, 255.538528442 * kRadPerDeg, 1e-6);
  EXPECT_EQ(headings(heading({.heading_deg = 360.0F})).at(0).second.heading_rad, 0.0);
  EXPECT_FALSE(known(headings(heading({.sigma_deg = 0.0F})).at(0).second.sigma_rad));
}

TEST(Novatel, AHeadingWithoutIntegerSolutionIsUnknown) {
  for (const Line& line : {Line{.status = 1, .heading_deg = kNanF}, Line{.type = 0}, Line{.type = 34},
                           Line{.type = 32}, Line{.type = 16}, Line{.sigma_deg = 180.0F}}) {
    const auto found = headings(heading(line));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(known(found[0].second.heading_rad) || known(found[0].second.sigma_rad));
  }
  for (const std::uint32_t type : {48U, 49U, 50U, 56U})
    EXPECT_TRUE(known(headings(heading({.type = type})).at(0).second.heading_rad)) << type;
  const Harvest other = decode("novatel", heading({.length_m = 800.0F}, kHeading2));
  EXPECT_EQ(other.samples.size(), 0U) << "the line to another vehicle";
  EXPECT_EQ(other.totals.frames_ignored, 1U);
}

TEST(Novatel, BothLogsOfATimeAreOneHeading) {
  const Line later{.head = {.tow_ms = 336'803'100}};
  EXPECT_EQ(headings(heading({}, kHeading2) + heading() + heading(later) + heading(later, kHeading2)).size(),
            2U);
  EXPECT_EQ(headings(heading() + heading(later) + heading()).size(), 3U);
  const auto found = headings(heading({.status = 1}, kHeading2) + heading());
  ASSERT_EQ(found.size(), 2U) << "the other one has a solution";
  EXPECT_TRUE(known(found[1].second.heading_rad));
}

TEST(Novatel, OtherFramesAreGoodOnesWithoutSample) {
  const ByteVector all = published();
  const ByteVector inertial(all.begin() + 180, all.begin() + 236);
  const ByteVector answer = log(kPositionLog, ByteVector{1, 0, 0, 0, 'O', 'K'}, {.type = 0x82});
  const ByteVector ascii = position({.head = {.type = 0x20}});
  const ByteVector secondary = position({.head = {.type = 0x01}}) + velocity({.head = {.type = 0x01}});
  const Harvest run =
      decode("novatel", inertial + answer + ascii + secondary + log(43, ByteVector(300, 0xAA)));
  EXPECT_TRUE(run.samples.empty());
  EXPECT_EQ(run.totals.frames_ignored, 6U);
  EXPECT_EQ(run.totals.rejected + run.totals.skipped_bytes, 0U);
  // Where nothing is said of the antenna there may be a 2.
  EXPECT_EQ(fixes(position({.head = {.type = 0x02}})).size(), 1U);
  // Headers and logs may grow.
  EXPECT_EQ(fixes(position({.head = {.length = 32}})).size(), 1U);
  EXPECT_EQ(fixes(position({.size = 80})).size(), 1U);
}

TEST(Novatel, DamageDoesNotSwallowWhatFollows) {
  const ByteVector text{'$', 'G', 'P', 'Z', 'D', 'A', '\r', '\n', 0xAA, 0x44, 0x14};
  EXPECT_EQ(fixes(text + position()).size(), 1U);
  for (const std::size_t at : {3U, 8U, 9U, 20U, 60U}) {
    ByteVector damaged = position();
    damaged[at] ^= 0x20;
    const Harvest run = decode("novatel", damaged + position() + position());
    EXPECT_EQ(run.samples.size(), 2U) << at;
    EXPECT_EQ(run.totals.rejected, 1U) << at;
  }
  const Harvest longer =
      decode("novatel", ByteVector{0xAA, 0x44, 0x12, 28, 42, 0, 0, 0x20, 0xF0, 0xFF, 0, 0} + position());
  const Harvest shorter = decode("novatel", log(43, {}, {.length = 27}) + position());
  for (const Harvest& run : {longer, shorter}) {
    ASSERT_EQ(run.rejected.size(), 1U);
    EXPECT_EQ(run.rejected[0].reason, RejectReason::length);
    EXPECT_EQ(run.samples.size(), 1U);
  }
}

class NovatelFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(NovatelFaults, AreRefusedOnceAndTheNextFrameIsFound) {
  expect_refused_once("novatel", GetParam(), position());
}

constexpr auto kBeyond = RejectReason::out_of_range;
constexpr Head kNoTime{.tow_ms = 604'800'000};

INSTANTIATE_TEST_SUITE_P(
    All, NovatelFaults,
    ::testing::Values(Fault{"latitude", position({.latitude_deg = -90.5}), kBeyond},
                      Fault{"longitude", position({.longitude_deg = 181.0}), kBeyond},
                      Fault{"longitude_no_number", position({.longitude_deg = kNan}), RejectReason::field},
                      Fault{"height", position({.height_msl_m = -2e5}), kBeyond},
                      Fault{"undulation", position({.undulation_m = kNanF}), RejectReason::field},
                      Fault{"negative_accuracy", position({.sigma_m = -1.0F}), kBeyond},
                      Fault{"type", position({.type = 8}), RejectReason::field},
                      Fault{"datum", position({.datum = 63}), RejectReason::field},
                      Fault{"time_of_the_week", position({.head = kNoTime}), kBeyond},
                      Fault{"week", position({.head = {.week = 0xFFFF}}), kBeyond},
                      Fault{"position_cut", position({.size = 71}), RejectReason::length},
                      Fault{"velocity_cut", velocity({.size = 40}), RejectReason::length},
                      Fault{"velocity_type", velocity({.type = 7}), RejectReason::field},
                      Fault{"velocity_no_number", velocity({.up_m_s = kNan}), RejectReason::field},
                      Fault{"velocity_time", velocity({.head = kNoTime}), kBeyond},
                      Fault{"negative_latency", velocity({.latency_s = -0.1F}), kBeyond},
                      Fault{"negative_speed", velocity({.speed_m_s = -1.0}), kBeyond},
                      Fault{"track", velocity({.track_deg = 720.0}), kBeyond},
                      Fault{"heading", heading({.heading_deg = 360.5F}), kBeyond},
                      Fault{"heading_no_number", heading({.heading_deg = kNanF}), RejectReason::field},
                      Fault{"pitch", heading({.pitch_deg = 91.0F}), kBeyond},
                      Fault{"heading_type", heading({.type = 99}), RejectReason::field},
                      Fault{"heading_time", heading({.head = kNoTime}), kBeyond},
                      Fault{"heading_cut", heading({.size = 40}, kHeading2), RejectReason::length},
                      Fault{"leap_seconds", time_log(-500.0), kBeyond},
                      Fault{"leap_seconds_no_number", time_log(kNan), RejectReason::field},
                      Fault{"time_cut", time_log(-18.0, 1, 40), RejectReason::length}),
    name_of_fault);

}  // namespace
}  // namespace fathom::codec::novatel_test

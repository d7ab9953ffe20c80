// Septentrio receivers: real blocks, and such laid by hand.
#include "codec/satellite/sbf/sbf.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "fault.hpp"
#include "sbf_bytes.hpp"

namespace fathom::codec::sbf_test {
namespace {

using namespace sbf_bytes;
using capture::Cut;
using capture::decode;
using capture::expect_refused_once;
using capture::Fault;
using capture::Harvest;
using capture::name_of_fault;
using capture::of_kind;

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

// Of a mosaic-X5 that was told where it is, and what it was told: 0.8932412891 and -0.03187402625 rad
// (SparkFun Extensible Message Parser, example SBF_in_SPARTN_Test).
const ByteVector kFixedLocation{
    0x24, 0x40, 0xC3, 0xF2, 0xA7, 0x4F, 0x60, 0x00, 0x80, 0x43, 0x6C, 0x1B, 0x63, 0x09, 0x03, 0x00,
    0x5B, 0xE2, 0x83, 0xC1, 0x6E, 0x95, 0xEC, 0x3F, 0x2D, 0xD3, 0xAB, 0xD8, 0xCA, 0x51, 0xA0, 0xBF,
    0x98, 0x52, 0x34, 0xB8, 0xBA, 0x79, 0x63, 0x40, 0x21, 0x72, 0x3E, 0x42, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF9, 0x02, 0x95, 0xD0, 0x46, 0x2D, 0x48, 0xD5,
    0xDB, 0xCE, 0xAD, 0x3F, 0x07, 0x14, 0xAB, 0x3D, 0x00, 0x00, 0x26, 0x00, 0xFF, 0xFF, 0xFF, 0xFF,
    0x01, 0x01, 0x22, 0x10, 0x01, 0x00, 0x00, 0x00, 0x34, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0x60, 0x00};

// The same receiver without antenna (example SBF_Test): every field but the latency has no value.
const ByteVector kNothing{0x24, 0x40, 0xC4, 0x86, 0xA7, 0x4F, 0x60, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF,
                          0x00, 0x01, 0x00, 0x00, 0x00, 0x20, 0x5F, 0xA0, 0x12, 0xC2, 0x00, 0x00, 0x00, 0x20,
                          0x5F, 0xA0, 0x12, 0xC2, 0x00, 0x00, 0x00, 0x20, 0x5F, 0xA0, 0x12, 0xC2, 0xF9, 0x02,
                          0x95, 0xD0, 0xF9, 0x02, 0x95, 0xD0, 0xF9, 0x02, 0x95, 0xD0, 0xF9, 0x02, 0x95, 0xD0,
                          0xF9, 0x02, 0x95, 0xD0, 0x00, 0x00, 0x00, 0x20, 0x5F, 0xA0, 0x12, 0xC2, 0xF9, 0x02,
                          0x95, 0xD0, 0xFF, 0xFF, 0xFF, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x00, 0x00, 0x00,
                          0x00, 0x00, 0x00, 0x00, 0x0B, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0x00};

// The same: a ReceiverTime without UTC, DeltaLS 18.
const ByteVector kReceiverTime{0x24, 0x40, 0x06, 0xFE, 0x1A, 0x17, 0x18, 0x00, 0xFF, 0xFF, 0xFF, 0xFF,
                               0xFF, 0xFF, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x12, 0x00, 0x00, 0x00};

// AttEuler with float ambiguities, heading 174.69456 deg at 2023-06-01 10:55:12 (septentrio-sbf of
// CoreMarine, README: NrSV 7, mode 1, Unix time 1685616912).
const ByteVector kFloatAttitude{0x24, 0x40, 0xB4, 0x93, 0x32, 0x17, 0x2C, 0x00, 0xD0, 0x90, 0xF1,
                                0x16, 0xD8, 0x08, 0x07, 0x00, 0x01, 0x00, 0x00, 0x00, 0xCF, 0xB1,
                                0x2E, 0x43, 0x3D, 0x50, 0x10, 0xC1, 0xF9, 0x02, 0x95, 0xD0, 0xEF,
                                0x94, 0x46, 0xBE, 0xF9, 0x02, 0x95, 0xD0, 0x0C, 0x41, 0xA0, 0x3E};

std::pair<Decoded, GpsSample> fix(const ByteVector& bytes) {
  const Harvest run = decode("sbf", bytes);
  const auto found = of_kind<GpsSample>(run);
  if (found.size() != 1 || !run.rejected.empty()) {
    ADD_FAILURE() << found.size() << " fixes, " << run.rejected.size() << " refused";
    return {};
  }
  return found[0];
}

HeadingSample heading(const ByteVector& bytes) {
  const Harvest run = decode("sbf", bytes);
  const auto found = of_kind<HeadingSample>(run);
  if (found.size() != 1 || !run.rejected.empty()) {
    ADD_FAILURE() << found.size() << " headings, " << run.rejected.size() << " refused";
    return {};
  }
  return found[0].second;
}

TEST(Sbf, ReadsWhatAReceiverSentOfItsFixedLocation) {
  const auto [decoded, s] = fix(kFixedLocation);
  EXPECT_EQ(s.fix, GpsFix::dead_reckoning) << "told, not measured";
  EXPECT_NEAR(s.latitude_rad, 0.8932412891, 1e-14);
  EXPECT_NEAR(s.longitude_rad, -0.03187402625, 1e-14);
  EXPECT_NEAR(s.altitude_m, 155.804, 1e-3);
  EXPECT_NEAR(s.altitude_m - s.altitude_msl_m, 47.6114, 1e-3);
  EXPECT_EQ(s.satellites, 38);
  EXPECT_EQ(s.velocity_N_m_s[0], 0.0);
  for (const double unknown : {s.course_rad, s.position_sigma_N_m[0], s.position_sigma_N_m[2]})
    EXPECT_FALSE(known(unknown));
  EXPECT_EQ(to_iso8601(decoded.time.utc_ns.value(), 3), "2026-01-30T07:47:42.000Z");
  EXPECT_EQ(decoded.time.age_ns, 5'200'000);
  EXPECT_EQ(decoded.length, kFixedLocation.size());
}

TEST(Sbf, WithoutAntennaThereIsNoFixAndNoTime) {
  const auto [decoded, s] = fix(kReceiverTime + kNothing);
  EXPECT_EQ(s.fix, GpsFix::none);
  EXPECT_EQ(s.satellites, -1);
  EXPECT_FALSE(known(s.latitude_rad) || known(s.altitude_m) || known(s.velocity_N_m_s[2]));
  EXPECT_FALSE(decoded.time.utc_ns.has_value());
  EXPECT_EQ(decoded.time.age_ns, 1'100'000);
  EXPECT_EQ(decoded.offset, kReceiverTime.size());
}

TEST(Sbf, AHeadingOfFloatAmbiguitiesIsUnknown) {
  const Harvest run = decode("sbf", kFloatAttitude);
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_FALSE(known(std::get<HeadingSample>(run.samples[0].sample).heading_rad));
  EXPECT_EQ(run.samples[0].time.utc_ns, 1'685'616'912 * kNsPerSecond);
  ByteVector fixed = kFloatAttitude;
  fixed[16] = 2;
  EXPECT_NEAR(heading(summed(fixed)).heading_rad * kDegPerRad, 174.69456481933594, 1e-12);
}

TEST(Sbf, ReadsEveryFieldOfAPosition) {
  const auto [decoded, s] = fix(pvt());
  EXPECT_EQ(s.fix, GpsFix::fix_3d);
  EXPECT_EQ(s.latitude_rad, -0.625);
  EXPECT_EQ(s.longitude_rad, 2.25);
  EXPECT_EQ(s.altitude_m, 44.5);
  EXPECT_EQ(s.altitude_msl_m, 18.25);
  EXPECT_EQ(s.velocity_N_m_s, (std::array{1.5, -0.5, -0.25})) << "the block says it upwards";
  EXPECT_DOUBLE_EQ(s.course_rad, 341.5 * kRadPerDeg);
  EXPECT_EQ(s.satellites, 17);
  EXPECT_DOUBLE_EQ(s.position_sigma_N_m[0], std::sqrt(2.0)) << "2DRMS of 4 m";
  EXPECT_DOUBLE_EQ(s.position_sigma_N_m[1], std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(s.position_sigma_N_m[2], 2.5) << "two sigmas of 5 m";
  EXPECT_FALSE(known(s.velocity_sigma_N_m_s[0]) || known(s.hdop));
  EXPECT_EQ(to_iso8601(decoded.time.utc_ns.value(), 3), "2026-09-19T10:30:15.250Z");
  EXPECT_FALSE(decoded.time.clock_ns.has_value());
}

TEST(Sbf, OlderRevisionsHaveNoAccuracies) {
  for (const unsigned revision : {0U, kRevision1}) {
    const auto [decoded, s] = fix(pvt({.revision = revision, .size = 88}));
    EXPECT_EQ(s.fix, GpsFix::fix_3d);
    EXPECT_FALSE(known(s.position_sigma_N_m[0]) || known(s.position_sigma_N_m[2]));
    EXPECT_FALSE(decoded.time.age_ns.has_value());
  }
  const auto s = fix(pvt({.revision = 3U << 13U, .size = 104})).second;
  EXPECT_DOUBLE_EQ(s.position_sigma_N_m[2], 2.5) << "later ones only grow";
}

TEST(Sbf, EachSolutionHasItsFix) {
  const std::pair<std::uint8_t, GpsFix> kMeaning[] = {
      {0, GpsFix::none},           {1, GpsFix::fix_3d},       {2, GpsFix::differential},
      {3, GpsFix::dead_reckoning}, {4, GpsFix::rtk_fixed},    {5, GpsFix::rtk_float},
      {6, GpsFix::differential},   {7, GpsFix::differential}, {8, GpsFix::differential},
      {10, GpsFix::differential},  {0x41, GpsFix::fix_3d},    {0x81, GpsFix::fix_2d},
      {0x84, GpsFix::fix_2d}};
  for (const auto& [mode, meaning] : kMeaning) {
    const auto s = fix(pvt({.mode = mode})).second;
    EXPECT_EQ(s.fix, meaning) << int{mode};
    EXPECT_EQ(known(s.latitude_rad), meaning != GpsFix::none) << int{mode};
    EXPECT_EQ(s.satellites, 17) << int{mode};
  }
}

TEST(Sbf, AFlatFixHasNoHeight) {
  const auto s = fix(pvt({.mode = 0x81})).second;
  EXPECT_FALSE(known(s.altitude_m) || known(s.altitude_msl_m) || known(s.position_sigma_N_m[2]));
  EXPECT_TRUE(known(s.position_sigma_N_m[0]) && known(s.velocity_N_m_s[0]));
}

TEST(Sbf, AMovingBaseIsNowhereForSure) {
  for (const std::uint8_t mode : {7, 8}) {
    const auto s = fix(covariance(kPosition, {.mode = mode}) + covariance(kVelocity, {.mode = mode}) +
                       pvt({.mode = mode}))
                       .second;
    EXPECT_FALSE(known(s.position_sigma_N_m[0]) || known(s.position_sigma_N_m[2]));
    EXPECT_DOUBLE_EQ(s.velocity_sigma_N_m_s[0], 0.5);
  }
}

TEST(Sbf, WhatTheReceiverDisownsIsNoFix) {
  EXPECT_EQ(fix(pvt({.error = 4})).second.fix, GpsFix::none);
  EXPECT_EQ(fix(pvt({.alert = 2})).second.fix, GpsFix::none) << "RAIM";
  EXPECT_EQ(fix(pvt({.alert = 5})).second.fix, GpsFix::none) << "of Galileo";
  EXPECT_EQ(fix(pvt({.alert = 0})).second.fix, GpsFix::fix_3d) << "not watched";
  EXPECT_EQ(fix(pvt({.alert = 9})).second.fix, GpsFix::fix_3d) << "a storm of the ionosphere";
}

TEST(Sbf, AFieldWithoutValueIsUnknown) {
  const auto s = fix(pvt({.height_m = -2e10,
                          .undulation_m = kNone,
                          .north_m_s = kNone,
                          .up_m_s = kNone,
                          .course_deg = kNone,
                          .satellites = 255,
                          .horizontal_cm = 65'535,
                          .vertical_cm = 65'535}))
                     .second;
  EXPECT_TRUE(known(s.latitude_rad) && known(s.longitude_rad));
  for (const double v : {s.altitude_m, s.altitude_msl_m, s.velocity_N_m_s[0], s.velocity_N_m_s[2],
                         s.course_rad, s.position_sigma_N_m[0], s.position_sigma_N_m[2]})
    EXPECT_FALSE(known(v));
  EXPECT_EQ(s.velocity_N_m_s[1], -0.5);
  EXPECT_EQ(s.satellites, -1);
  EXPECT_TRUE(known(fix(pvt({.undulation_m = kNone})).second.altitude_m));
  EXPECT_FALSE(known(fix(pvt({.horizontal_cm = 0})).second.position_sigma_N_m[0]));
  EXPECT_EQ(fix(pvt({.course_deg = 360.0F})).second.course_rad, 0.0);
  EXPECT_FALSE(fix(pvt({.tow_ms = 0xFFFF'FFFF})).first.time.utc_ns);
  EXPECT_FALSE(fix(pvt({.week = 0xFFFF})).first.time.utc_ns);
}

TEST(Sbf, TwoAntennasGiveAHeading) {
  for (const std::uint16_t mode : {2, 4}) {
    const HeadingSample s = heading(attitude_covariance() + attitude({.mode = mode}));
    EXPECT_EQ(s.north, North::true_north);
    EXPECT_DOUBLE_EQ(s.heading_rad, 271.5 * kRadPerDeg);
    EXPECT_DOUBLE_EQ(s.sigma_rad, 0.25 * kRadPerDeg);
  }
  EXPECT_EQ(heading(attitude({.heading_deg = 360.0F})).heading_rad, 0.0);
  EXPECT_TRUE(known(heading(attitude({.error = 4})).heading_rad)) << "the second baseline is not used";
  for (const AttitudeFields& none :
       {AttitudeFields{.mode = 0}, AttitudeFields{.mode = 1}, AttitudeFields{.mode = 3},
        AttitudeFields{.error = 1}, AttitudeFields{.error = 0x80}, AttitudeFields{.heading_deg = kNone}}) {
    const HeadingSample s = heading(attitude_covariance() + attitude(none));
    EXPECT_FALSE(known(s.heading_rad) || known(s.sigma_rad));
  }
  for (const float variance : {kNone, 0.0F})
    EXPECT_FALSE(known(heading(attitude_covariance(kTow_ms, variance) + attitude()).sigma_rad));
}

TEST(Sbf, TheReceiverKnowsItsLeapSeconds) {
  const auto utc = [](const ByteVector& bytes) {
    return to_iso8601(fix(bytes).first.time.utc_ns.value(), 3);
  };
  EXPECT_EQ(utc(pvt()), "2026-09-19T10:30:15.250Z");
  EXPECT_EQ(utc(receiver_time(19) + pvt()), "2026-09-19T10:30:14.250Z");
  EXPECT_EQ(utc(receiver_time(19) + receiver_time(-128) + pvt()), "2026-09-19T10:30:14.250Z");
  EXPECT_EQ(utc(kReceiverTime + pvt()), "2026-09-19T10:30:15.250Z");
}

/// RFStatus with a band for each mode.
ByteVector rf_status(std::uint8_t flags, const ByteVector& modes, std::uint32_t tow_ms = kTow_ms,
                     std::uint8_t band_length = 8) {
  ByteVector body{static_cast<std::uint8_t>(modes.size()), band_length, flags, 0, 0, 0};
  for (const std::uint8_t mode : modes) {
    append_le<std::uint32_t>(body, 1'575'420'000);
    append_le<std::uint16_t>(body, 500);
    body = body + ByteVector{mode, 0};
  }
  return block(4092, body, tow_ms);
}

TEST(Sbf, InterferenceGoesIntoTheFixesThatFollow) {
  const auto after = [](const ByteVector& status, const PvtFields& f = {}) {
    return fix(status + pvt(f)).second;
  };
  EXPECT_EQ(fix(pvt()).second.jamming, GpsJamming::unknown);
  EXPECT_EQ(fix(pvt()).second.spoofing, GpsSpoofing::unknown);
  EXPECT_EQ(after(rf_status(0, {})).jamming, GpsJamming::none);
  EXPECT_EQ(after(rf_status(0, {})).spoofing, GpsSpoofing::none);
  EXPECT_EQ(after(rf_status(0, {1})).jamming, GpsJamming::none) << "a filter that somebody has set";
  EXPECT_EQ(after(rf_status(0, {1, 0x42})).jamming, GpsJamming::warning);
  EXPECT_EQ(after(rf_status(0, {8, 1})).jamming, GpsJamming::warning);
  EXPECT_EQ(after(rf_status(0, {8}), {.mode = 0, .error = 1}).jamming, GpsJamming::critical);
  EXPECT_EQ(after(rf_status(0, {2}), {.mode = 0, .error = 1}).jamming, GpsJamming::warning);
  EXPECT_EQ(after(rf_status(1, {})).spoofing, GpsSpoofing::indicated);
  EXPECT_EQ(after(rf_status(2, {})).spoofing, GpsSpoofing::indicated);
  EXPECT_EQ(after(rf_status(3, {})).spoofing, GpsSpoofing::affirmed);
  EXPECT_EQ(after(rf_status(1, {}, kTow_ms - 10'000)).spoofing, GpsSpoofing::indicated);
  EXPECT_EQ(after(rf_status(1, {}, kTow_ms - 10'001)).spoofing, GpsSpoofing::unknown);
  ByteVector untimed = rf_status(1, {}, 0xFFFF'FFFF);
  for (int i = 0; i < 51; ++i) untimed = untimed + pvt({.tow_ms = 0xFFFF'FFFF});
  const Harvest run = decode("sbf", untimed);
  const auto found = of_kind<GpsSample>(run);
  ASSERT_EQ(found.size(), 51U);
  EXPECT_EQ(found[49].second.spoofing, GpsSpoofing::indicated);
  EXPECT_EQ(found[50].second.spoofing, GpsSpoofing::unknown);
}

TEST(Sbf, OtherBlocksAndOtherTextAreNoDamage) {
  // PVTCartesian (pysbf2, tests/test_parse.py).
  const ByteVector cartesian{
      0x24, 0x40, 0xB7, 0x59, 0xA6, 0x0F, 0x60, 0x00, 0x58, 0x9B, 0x73, 0x0C, 0x3F, 0x09, 0x04, 0x00,
      0x1D, 0x0E, 0x58, 0x17, 0xFC, 0x04, 0x4D, 0x41, 0xE6, 0xE4, 0x8B, 0xE6, 0xEA, 0x29, 0x02, 0xC1,
      0x98, 0x19, 0x28, 0xB2, 0x18, 0x75, 0x53, 0x41, 0xA6, 0xDD, 0x41, 0x42, 0x51, 0x90, 0x01, 0x38,
      0xB4, 0x86, 0x71, 0x3A, 0xC0, 0x93, 0x85, 0xBB, 0xF9, 0x02, 0x95, 0xD0, 0xE3, 0xAF, 0xE6, 0x6E,
      0x4B, 0x6C, 0xDE, 0x3F, 0x03, 0xE0, 0x56, 0x3E, 0x00, 0x00, 0x10, 0x40, 0x8F, 0x02, 0x8F, 0x02,
      0x0D, 0x09, 0x32, 0x50, 0x00, 0x00, 0x00, 0x00, 0x2B, 0x00, 0x7A, 0x00, 0x88, 0x00, 0x00, 0x01};
  const std::string text = "$R: setSBFOutput\r\n$GPHDT,271.5,T*3F\r\n";
  const ByteVector said(text.begin(), text.end());
  const Harvest run = decode("sbf", cartesian + said + pvt() + end_of_att() + said);
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.rejected, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 2U);
  EXPECT_EQ(run.totals.skipped_bytes, 2 * text.size());
}

TEST(Sbf, ADamagedBlockSwallowsNothing) {
  // A header that wants nearly all that is believed, in front of good blocks.
  const ByteVector header{'$', '@', 1, 2, 0xA7, 0x4F, 0xFC, 0x1F, 3, 4, 5};
  ByteVector many;
  for (std::uint32_t i = 0; i < 100; ++i) many = many + pvt({.tow_ms = kTow_ms + i});
  for (const Cut cut : {Cut{}, Cut{Cut::Kind::bytes}, Cut{Cut::Kind::random, 7}}) {
    const Harvest run = decode("sbf", header + many, cut);
    EXPECT_EQ(run.totals.samples, 100U);
    ASSERT_EQ(run.rejected.size(), 1U);
    EXPECT_EQ(run.rejected[0].reason, RejectReason::checksum);
    // Cut short it is found when the stream ends.
    const Harvest short_run = decode("sbf", header + pvt(), cut);
    EXPECT_EQ(short_run.totals.samples, 1U);
    ASSERT_EQ(short_run.rejected.size(), 1U);
    EXPECT_EQ(short_run.rejected[0].reason, RejectReason::truncated);
  }
  // A block inside of a damaged one.
  ByteVector damaged = pvt();
  damaged.insert(damaged.begin() + 40, {'$', '@'});
  EXPECT_EQ(decode("sbf", damaged + pvt()).totals.samples, 1U);
}

class SbfFaults : public ::testing::TestWithParam<Fault> {};

TEST_P(SbfFaults, AreRefusedOnceAndTheNextBlockIsFound) {
  expect_refused_once("sbf", GetParam(), pvt({.tow_ms = 1'000}));
}

ByteVector with_byte(ByteVector bytes, std::size_t at, std::uint8_t value) {
  bytes[at] = value;
  return bytes;
}

constexpr auto kOutside = RejectReason::out_of_range;
constexpr auto kField = RejectReason::field;
constexpr auto kLength = RejectReason::length;

INSTANTIATE_TEST_SUITE_P(
    All, SbfFaults,
    ::testing::Values(Fault{"crc", with_byte(kReceiverTime, 16, 0xFF), RejectReason::checksum},
                      Fault{"length_odd", with_byte(kReceiverTime, 6, 0x17), kLength},
                      Fault{"length_none", with_byte(kReceiverTime, 6, 4), kLength},
                      Fault{"length_beyond", with_byte(kReceiverTime, 7, 0x21), kLength},
                      Fault{"latitude", pvt({.latitude_rad = 1.6}), kOutside},
                      Fault{"longitude", pvt({.longitude_rad = -3.2}), kOutside},
                      Fault{"no_latitude", pvt({.latitude_rad = -2e10}), RejectReason::incomplete},
                      Fault{"longitude_no_number", pvt({.longitude_rad = kNoNumber}), kField},
                      Fault{"height", pvt({.height_m = 2e5}), kOutside},
                      Fault{"undulation", pvt({.undulation_m = kNoNumber}), kField},
                      Fault{"velocity", pvt({.north_m_s = -2e4F}), kOutside},
                      Fault{"course", pvt({.course_deg = -1.0F}), kOutside},
                      Fault{"mode", pvt({.mode = 9}), kField},
                      Fault{"mode_beyond", pvt({.mode = 15}), kField},
                      Fault{"datum_of_a_user", pvt({.datum = 250}), kField},
                      Fault{"time_of_the_week", pvt({.tow_ms = 604'800'000}), kOutside},
                      Fault{"week", pvt({.week = 7'001}), kOutside},
                      Fault{"cut", pvt({.revision = 0, .size = 84}), kLength},
                      Fault{"revision_2_cut", pvt({.size = 92}), kLength},
                      Fault{"variance", covariance(kPosition, {.north = -0.5F}), kOutside},
                      Fault{"variance_no_number", covariance(kVelocity, {.vertical = kNoNumber}), kField},
                      Fault{"covariance_mode", covariance(kVelocity, {.mode = 11}), kField},
                      Fault{"covariance_cut", covariance(kPosition, {.size = 52}), kLength},
                      Fault{"heading", attitude({.heading_deg = 360.5F}), kOutside},
                      Fault{"heading_no_number", attitude({.heading_deg = kNoNumber}), kField},
                      Fault{"attitude_mode", attitude({.mode = 5}), kField},
                      Fault{"attitude_time", attitude({.tow_ms = 604'800'000}), kOutside},
                      Fault{"attitude_cut", attitude({.size = 40}), kLength},
                      Fault{"attitude_variance", attitude_covariance(kTow_ms, -1.0F), kOutside},
                      Fault{"attitude_covariance_cut", attitude_covariance(kTow_ms, 1.0F, 36), kLength},
                      Fault{"bands", rf_status(0, {1, 1}, kTow_ms, 20), RejectReason::structure},
                      Fault{"band_cut", rf_status(0, {1}, kTow_ms, 6), RejectReason::structure},
                      Fault{"leap_seconds", receiver_time(-3), kOutside},
                      Fault{"receiver_time_cut", receiver_time(18, 20), kLength}),
    name_of_fault);

}  // namespace
}  // namespace fathom::codec::sbf_test

// Positions told, one a line.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/iso8601.hpp"
#include "base/units.hpp"
#include "nmea_text.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;
using test::sentence;

DecodeRun told_by(const std::string& text, bool require_checksum = false) {
  CodecOptions options;
  options.require_checksum = require_checksum;
  return decode_text("fix_text", text, options);
}

TEST(FixText, ALineIsAPositionAtItsInstant) {
  const DecodeRun told = told_by(sentence("PFTHX,2026-01-31T12:00:00.5Z,36.4009,-127.25,20"), true);
  ASSERT_EQ(told.samples.size(), 1U);
  const auto& fix = std::get<FixSample>(told.samples[0].sample);
  EXPECT_DOUBLE_EQ(fix.latitude_rad, 36.4009 * kRadPerDeg);
  EXPECT_DOUBLE_EQ(fix.longitude_rad, -127.25 * kRadPerDeg);
  EXPECT_EQ(fix.sigma_m, 20.0);
  EXPECT_TRUE(std::isnan(fix.depth_m));
  EXPECT_TRUE(std::isnan(fix.depth_sigma_m));
  EXPECT_EQ(told.samples[0].time.utc_ns, from_iso8601("2026-01-31T12:00:00.5Z"));
}

TEST(FixText, WhatIsKnownOfTheDepthComesBehind) {
  const DecodeRun told =
      told_by(sentence("PFTHX,,36.4,127.25,20,12.5,0.5") + sentence("PFTHX,,36.4,127.25,20,12.5"));
  ASSERT_EQ(told.samples.size(), 2U);
  const auto& both = std::get<FixSample>(told.samples[0].sample);
  EXPECT_EQ(both.depth_m, 12.5);
  EXPECT_EQ(both.depth_sigma_m, 0.5);
  EXPECT_TRUE(std::isnan(std::get<FixSample>(told.samples[1].sample).depth_sigma_m));
  EXPECT_FALSE(told.samples[0].time.utc_ns);  // now
}

TEST(FixText, TheChecksumMayBeLeftOutWhereTheConfigurationSaysSo) {
  const std::string line = "$PFTHX,2026-01-31T12:00:00Z,36.4,127.25,20\n";
  EXPECT_EQ(told_by(line).samples.size(), 1U);
  const DecodeRun strict = told_by(line, true);
  EXPECT_EQ(strict.samples.size(), 0U);
  ASSERT_EQ(strict.rejected.size(), 1U);
  EXPECT_EQ(strict.rejected[0].reason, RejectReason::no_checksum);
}

TEST(FixText, WhatIsNoPositionIsRefusedWithItsReason) {
  const std::pair<const char*, RejectReason> bad[] = {
      {"PFTHX,2026-01-31T12:00:00Z,36.4,127.25", RejectReason::structure},
      {"PFTHX,2026-01-31T12:00:00Z,36.4,127.25,20,1,1,1", RejectReason::structure},
      {"PFTHX,yesterday,36.4,127.25,20", RejectReason::field},
      {"PFTHX,2026-01-31T12:00:00,36.4,127.25,20", RejectReason::field},
      {"PFTHX,,36.4N,127.25,20", RejectReason::field},
      {"PFTHX,,91,127.25,20", RejectReason::out_of_range},
      {"PFTHX,,36.4,-180.1,20", RejectReason::out_of_range},
      {"PFTHX,,36.4,127.25,0", RejectReason::out_of_range},
      {"PFTHX,,36.4,127.25,", RejectReason::incomplete},
      {"PFTHX,,,127.25,20", RejectReason::incomplete}};
  for (const auto& [body, reason] : bad) {
    const DecodeRun told = told_by(sentence(body));
    EXPECT_EQ(told.samples.size(), 0U) << body;
    ASSERT_EQ(told.rejected.size(), 1U) << body;
    EXPECT_EQ(told.rejected[0].reason, reason) << body;
  }
}

TEST(FixText, OtherSentencesAreIgnored) {
  const DecodeRun told = told_by(sentence("GPGLL,3624.0,N,12715.0,E,120000,A"));
  EXPECT_TRUE(told.samples.empty());
  EXPECT_TRUE(told.rejected.empty());
}

}  // namespace
}  // namespace fathom::codec

#include "codec/text/nmea_sentence.hpp"

#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "nmea_text.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::sentence;

RejectReason only_reason(std::string_view text) {
  const test::DecodeRun run = decode_text("nmea0183", text);
  EXPECT_EQ(run.rejected.size(), 1U) << text;
  EXPECT_TRUE(run.samples.empty()) << text;
  return run.rejected.empty() ? RejectReason::truncated : run.rejected[0].reason;
}

TEST(NmeaSentence, ChecksumInEitherCaseAndWithoutWaitingForTheLineEnd) {
  for (const std::string_view text : {"$GPHDT,25.50,T*37", "$GPHDT,25.50,T*37\r\n", "$GNROT,35.6,A*1f"}) {
    const test::DecodeRun run = decode_text("nmea0183", text);
    EXPECT_TRUE(run.rejected.empty()) << text;
    EXPECT_EQ(run.totals.samples + run.totals.frames_ignored, 1U) << text;
    EXPECT_EQ(run.totals.skipped_bytes, 0U) << text;
  }
  auto codec = find_protocol("nmea0183")->make({});
  test::DecodeRun run;
  codec->feed(test::bytes_of("$GPHDT,25.50,T*37"), run);
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.samples[0].length, 17U);
}

TEST(NmeaSentence, OneReasonPerRefusedSentence) {
  EXPECT_EQ(only_reason("$GPHDT,25.51,T*37\r\n"), RejectReason::checksum);
  EXPECT_EQ(only_reason("$GPHDT,25.50,T*3\r\n"), RejectReason::checksum);
  EXPECT_EQ(only_reason("$GPHDT,25.50,T*ZZ\r\n"), RejectReason::checksum);
  EXPECT_EQ(only_reason("$GPHDT,25.50,T\r\n"), RejectReason::no_checksum);
  EXPECT_EQ(only_reason("$GPHDT,25.50,T*\r\n"), RejectReason::no_checksum);
  EXPECT_EQ(only_reason("$GPHDT,25.5\x01,T*37\r\n"), RejectReason::structure);
  EXPECT_EQ(only_reason("$GPHDT,25.50"), RejectReason::truncated);
}

TEST(NmeaSentence, ChecksumMayBeAbsentWhereTheConfigurationSaysSo) {
  CodecOptions lenient;
  lenient.require_checksum = false;
  EXPECT_EQ(decode_text("nmea0183", "$GPHDT,25.50,T\r\n", lenient).samples.size(), 1U);
  EXPECT_EQ(decode_text("nmea0183", "$GPHDT,25.50,T*\r\n", lenient).samples.size(), 1U);
  // A wrong one stays wrong.
  EXPECT_EQ(decode_text("nmea0183", "$GPHDT,25.51,T*37\r\n", lenient).rejected.size(), 1U);
}

TEST(NmeaSentence, ACutSentenceDoesNotTakeTheNextOneWithIt) {
  const test::DecodeRun run = decode_text("nmea0183", "$GPHDT,2$GPHDT,25.50,T*37\r\n");
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, RejectReason::length);
  EXPECT_EQ(run.rejected[0].length, 8U);
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.samples[0].offset, 8U);
}

TEST(NmeaSentence, GluedSentencesWithAValidChecksumAreRefusedByTheirShape) {
  // Seen from a receiver at cold boot: RMC whose middle is missing, with the checksum of what is left.
  EXPECT_EQ(only_reason(sentence("GPRMC,000344.03,A,4808.9992,N,4,02.3")), RejectReason::structure);
}

TEST(NmeaSentence, LongSentencesPassAndEndlessOnesDoNot) {
  const std::string long_body = "GNTXT," + std::string(424 - 6, 'x');
  EXPECT_EQ(decode_text("nmea0183", sentence(long_body)).totals.frames_ignored, 1U);
  const test::DecodeRun endless =
      decode_text("nmea0183", "$GNTXT," + std::string(3000, 'x') + "\r\n" + "$GPHDT,25.50,T*37\r\n");
  ASSERT_EQ(endless.rejected.size(), 1U);
  EXPECT_EQ(endless.rejected[0].reason, RejectReason::length);
  EXPECT_EQ(endless.rejected[0].length, kMaxSentence);
  EXPECT_EQ(endless.samples.size(), 1U);
}

TEST(NmeaSentence, DollarSignsThatBeginNoSentenceAreSkipped) {
  const test::DecodeRun run =
      decode_text("nmea0183", "price $5, $=, $GP$lower,$ABCDEFGHIJKL,x $GPHDT,25.50,T*37\r\n");
  EXPECT_EQ(run.samples.size(), 1U);
  EXPECT_TRUE(run.rejected.empty());
}

TEST(NmeaSentence, EncapsulatedSentencesAreGoodFramesWithoutSample) {
  const test::DecodeRun run = decode_text("nmea0183", "!AIVDM,1,1,,A,14eG;o@034o8sd<L9i:a;WF>062D,0*7D\r\n");
  EXPECT_EQ(run.totals.frames_ignored, 1U);
  EXPECT_TRUE(run.rejected.empty());
}

TEST(NmeaSentence, SkipsBinaryBetweenSentences) {
  std::string stream = "\xB5\x62\x01\x07\x04";
  stream += std::string("\x00\xFF$\x01", 4);
  stream += "$GPHDT,25.50,T*37\r\n\xD3";
  const test::DecodeRun run = decode_text("nmea0183", stream);
  EXPECT_EQ(run.samples.size(), 1U);
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.skipped_bytes, 10U);
}

TEST(FieldReader, LatitudeAndLongitude) {
  const auto latitude = [](std::string_view digits, std::string_view side) {
    Sentence s;
    s.field = {digits, side};
    s.fields = 2;
    FieldReader fields(s);
    const double value = fields.latitude(0);
    return std::pair(value, fields.refused());
  };
  EXPECT_NEAR(latitude("4807.038", "N").first, (48.0 + 7.038 / 60.0) * kRadPerDeg, 1e-15);
  EXPECT_NEAR(latitude("4807.038", "S").first, -(48.0 + 7.038 / 60.0) * kRadPerDeg, 1e-15);
  EXPECT_NEAR(latitude("0000.0001", "N").first, 0.0001 / 60.0 * kRadPerDeg, 1e-18);
  EXPECT_TRUE(std::isnan(latitude("", "").first));
  EXPECT_FALSE(latitude("", "").second.has_value());
  EXPECT_TRUE(std::isnan(latitude("4807.038", "").first));
  EXPECT_EQ(latitude("9000.0001", "N").second, RejectReason::out_of_range);
  EXPECT_EQ(latitude("4860.0", "N").second, RejectReason::out_of_range);
  EXPECT_EQ(latitude("4807.038", "E").second, RejectReason::field);
  EXPECT_EQ(latitude("-807.038", "N").second, RejectReason::field);
  EXPECT_EQ(latitude("48x7.038", "N").second, RejectReason::field);
  EXPECT_EQ(latitude("nan", "N").second, RejectReason::field);
  EXPECT_EQ(latitude("7.038", "N").second, RejectReason::field);
}

TEST(FieldReader, TimeOfDay) {
  const auto time = [](std::string_view digits) {
    Sentence s;
    s.field = {digits};
    s.fields = 1;
    FieldReader fields(s);
    const auto value = fields.time_of_day(0);
    return std::pair(value, fields.refused());
  };
  EXPECT_EQ(time("000000").first, 0);
  EXPECT_EQ(time("123519.25").first, (12 * 3600 + 35 * 60 + 19) * kNsPerSecond + 250 * kNsPerMillisecond);
  EXPECT_EQ(time("235959.999999999999").first, 86'399 * kNsPerSecond + 999'999'999);
  EXPECT_EQ(time("235960").first, 86'400 * kNsPerSecond);
  EXPECT_FALSE(time("").second.has_value());
  EXPECT_EQ(time("240000").second, RejectReason::out_of_range);
  EXPECT_EQ(time("126000").second, RejectReason::out_of_range);
  EXPECT_EQ(time("12351").second, RejectReason::field);
  EXPECT_EQ(time("1235199").second, RejectReason::field);
  EXPECT_EQ(time("123519.2x").second, RejectReason::field);
  EXPECT_EQ(time("|19322|1.00").second, RejectReason::field);
}

TEST(SplitSentence, TalkerTypeAndEmptyFields) {
  const std::string text = "$GNGGA,,1,*00";
  const test::ByteVector frame = test::bytes_of(text);
  const Sentence s = split_sentence(frame);
  EXPECT_EQ(s.talker, "GN");
  EXPECT_EQ(s.type, "GGA");
  EXPECT_EQ(s.field[1], "1");
  EXPECT_EQ(s.fields, 3U);
  const std::string proprietary = "$PSIMSSB,1*00";
  const test::ByteVector bytes = test::bytes_of(proprietary);
  EXPECT_EQ(split_sentence(bytes).type, "PSIMSSB");
  EXPECT_TRUE(split_sentence(bytes).talker.empty());
}

}  // namespace
}  // namespace fathom::codec

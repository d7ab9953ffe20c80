// Height above the bottom by NMEA 0183.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "nmea_text.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;
using test::sentence;

AltimeterSample altimeter(const std::string& body) {
  const DecodeRun run = decode_text("nmea0183", sentence(body));
  EXPECT_EQ(run.samples.size(), 1U) << body;
  return run.samples.empty() ? AltimeterSample{} : std::get<AltimeterSample>(run.samples[0].sample);
}

RejectReason refused(const std::string& text) {
  const DecodeRun run = decode_text("nmea0183", text);
  EXPECT_EQ(run.rejected.size(), 1U) << text;
  EXPECT_TRUE(run.samples.empty()) << text;
  return run.rejected.empty() ? RejectReason::truncated : run.rejected[0].reason;
}

TEST(NmeaAltimeter, DptWithItsOffsetBesideIt) {
  const AltimeterSample water = altimeter("SDDPT,2.4,0.5");
  EXPECT_EQ(water.altitude_m, 2.4);
  EXPECT_EQ(water.transducer_offset_m, 0.5);
  EXPECT_TRUE(std::isnan(water.sigma_m));
  EXPECT_FALSE(water.vertical);
  const AltimeterSample keel = altimeter("INDPT,47.31,-1.25,200.0");  // version 3: with the range in use
  EXPECT_EQ(keel.altitude_m, 47.31);
  EXPECT_EQ(keel.transducer_offset_m, -1.25);
}

TEST(NmeaAltimeter, DbtGivesItsMetres) {
  const AltimeterSample sample = altimeter("SDDBT,7.8,f,2.4,M,1.3,F");
  EXPECT_EQ(sample.altitude_m, 2.4);
  EXPECT_TRUE(std::isnan(sample.transducer_offset_m));
  EXPECT_EQ(altimeter("SDDBT,,f,22.5,M,,F").altitude_m, 22.5);
}

TEST(NmeaAltimeter, SentencesFromTheBookWithTheirChecksums) {
  const DecodeRun run = decode_text("nmea0183", "$INDPT,2.3,0.0*46\r\n$SDDBT,8.1,f,2.4,M,1.3,F*0B\r\n");
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(std::get<AltimeterSample>(run.samples[0].sample).altitude_m, 2.3);
  EXPECT_EQ(std::get<AltimeterSample>(run.samples[1].sample).altitude_m, 2.4);
}

TEST(NmeaAltimeter, WithoutABottomItIsAliveAndKnowsNone) {
  EXPECT_TRUE(std::isnan(altimeter("SDDPT,,0.5").altitude_m));
  EXPECT_TRUE(std::isnan(altimeter("SDDPT,12.5,").transducer_offset_m));
  EXPECT_TRUE(std::isnan(altimeter("SDDBT,,f,,M,,F").altitude_m));
}

TEST(ValeportAltimeter, GivesRangeAndAbsolutePressure) {
  // As published, of an instrument in air.
  const DecodeRun run = decode_text("nmea0183", "$PRVAT,00.115,M,0010.073,dBar*39\r\n");
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(std::get<AltimeterSample>(run.samples[0].sample).altitude_m, 0.115);
  const auto& depth = std::get<DepthSample>(run.samples[1].sample);
  EXPECT_NEAR(depth.pressure_Pa, 100'730.0, 1e-6);
  EXPECT_NEAR(depth.depth_m, -0.0592, 1e-4);  // 595 Pa less than the standard atmosphere

  CodecOptions options;
  options.latitude_rad = 30.0 * kRadPerDeg;
  options.atmosphere_Pa = 100'730.0;
  const DecodeRun deep = decode_text("nmea0183", sentence("PRVAT,12.345,M,1010.073,dBar"), options);
  ASSERT_EQ(deep.samples.size(), 2U);
  EXPECT_NEAR(std::get<DepthSample>(deep.samples[1].sample).depth_m, 990.81, 0.02);
  EXPECT_EQ(altimeter("PRVAT,07.500,M").altitude_m, 7.5);  // a model without pressure
  const DecodeRun metres = decode_text("nmea0183", "$PRVAT,00.210,M,0007.497,Metres*3a\r\n");  // likewise
  ASSERT_EQ(metres.samples.size(), 1U);
  EXPECT_EQ(std::get<AltimeterSample>(metres.samples[0].sample).altitude_m, 0.21);
}

TEST(ValeportAltimeter, KeepsTheOneWhereTheOtherCannotBe) {
  const DecodeRun no_range = decode_text("nmea0183", sentence("PRVAT,x,M,0020.000,dBar"));
  ASSERT_EQ(no_range.samples.size(), 2U);
  EXPECT_TRUE(std::isnan(std::get<AltimeterSample>(no_range.samples[0].sample).altitude_m));
  EXPECT_EQ(altimeter("PRVAT,07.500,M,0020.000,PSI").altitude_m, 7.5);
  EXPECT_EQ(altimeter("PRVAT,07.500,M,99999,dBar").altitude_m, 7.5);
  EXPECT_TRUE(std::isnan(altimeter("PRVAT,,M").altitude_m));
  EXPECT_EQ(refused(sentence("PRVAT,07.500,F")), RejectReason::field);
  EXPECT_EQ(refused(sentence("PRVAT,x,M,99999,dBar")), RejectReason::field);
  EXPECT_EQ(refused(sentence("PRVAT,12000.1,M")), RejectReason::out_of_range);
  EXPECT_EQ(refused(sentence("PRVAT,,M,99999,dBar")), RejectReason::out_of_range);
  EXPECT_EQ(refused(sentence("PRVAT,,M,0000.100,dBar")), RejectReason::out_of_range);
  EXPECT_EQ(refused(sentence("PRVAT,,M,0020.000,PSI")), RejectReason::field);
  EXPECT_TRUE(std::isnan(altimeter("PRVAT,,M,0007.497,Metres").altitude_m));
  EXPECT_EQ(refused(sentence("PRVAT,07.500,M,0020.000")), RejectReason::structure);
  EXPECT_EQ(refused("$PRVAT,00.116,M,0010.073,dBar*39\r\n"), RejectReason::checksum);
}

TEST(AsciiAltitude, PrefixNumberAndWhatMayFollow) {
  const auto altitudes = [](const std::string& text, const CodecOptions& options) {
    std::vector<double> out;
    for (const auto& sample : decode_text("ascii_altitude", text, options).all<AltimeterSample>())
      out.push_back(sample.altitude_m);
    return out;
  };
  EXPECT_EQ(altitudes("012.345m\r\n007.5\r\n", {}), (std::vector{12.345, 7.5}));
  CodecOptions feet;
  feet.ascii_prefix = "R";
  feet.ascii_scale = 0.3048;
  feet.ascii_offset = 0.1;
  EXPECT_DOUBLE_EQ(altitudes("status ok\r\nR100.0\r\n", feet).at(0), 30.58);
  EXPECT_TRUE(std::isnan(altitudes("000.000m\r\n", {}).at(0)));  // no bottom
  for (const char* bad : {"12.5x3\r\n", "nan\r\n", "-1.0m\r\n", "12000.1m\r\n"})
    EXPECT_EQ(decode_text("ascii_altitude", bad).rejected.size(), 1U) << bad;
}

TEST(NmeaAltimeter, DamageAndNonsenseAreRefused) {
  EXPECT_EQ(refused("$INDPT,2.3,0.0*47\r\n"), RejectReason::checksum);
  EXPECT_EQ(refused(sentence("SDDPT,2.4")), RejectReason::structure);
  EXPECT_EQ(refused(sentence("SDDPT,2.4,0.5,100.0,1")), RejectReason::structure);
  EXPECT_EQ(refused(sentence("SDDBT,7.8,f,2.4,M")), RejectReason::structure);
  EXPECT_EQ(refused(sentence("SDDPT,2x4,0.5")), RejectReason::field);
  EXPECT_EQ(refused(sentence("SDDBT,7.8,f,2.4,m,1.3,F")), RejectReason::field);
  EXPECT_EQ(refused(sentence("SDDPT,-0.1,0.5")), RejectReason::out_of_range);
  EXPECT_EQ(refused(sentence("SDDPT,12000.1,0.5")), RejectReason::out_of_range);
  EXPECT_EQ(refused(sentence("SDDPT,2.4,1000.5")), RejectReason::out_of_range);
}

}  // namespace
}  // namespace fathom::codec

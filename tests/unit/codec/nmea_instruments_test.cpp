// Heading, propulsion, fins, and acoustic positions by NMEA 0183.

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "nmea_text.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;
using test::sentence;

HeadingSample heading(const std::string& body) {
  const DecodeRun run = decode_text("heading", sentence(body));
  EXPECT_EQ(run.samples.size(), 1U) << body;
  return run.samples.empty() ? HeadingSample{} : std::get<HeadingSample>(run.samples[0].sample);
}

RejectReason refused(const std::string& body) {
  const DecodeRun run = decode_text("nmea0183", sentence(body));
  EXPECT_EQ(run.rejected.size(), 1U) << body;
  EXPECT_TRUE(run.samples.empty()) << body;
  return run.rejected.empty() ? RejectReason::truncated : run.rejected[0].reason;
}

TEST(NmeaHeading, TrueAndMagnetic) {
  EXPECT_NEAR(heading("HEHDT,274.07,T").heading_rad, 274.07 * kRadPerDeg, 1e-12);
  EXPECT_EQ(heading("HEHDT,274.07,T").north, North::true_north);
  EXPECT_EQ(heading("HCHDM,120.5,M").north, North::magnetic);
  EXPECT_EQ(heading("HEHDT,360.0,T").heading_rad, 0.0);
}

TEST(NmeaHeading, ThsOnlyInAutonomousMode) {
  EXPECT_NEAR(heading("GPTHS,23.34,A").heading_rad, 23.34 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(heading("GPTHS,23.34").heading_rad, 23.34 * kRadPerDeg, 1e-12);
  for (const char* mode : {"E", "M", "S", "V"}) {
    EXPECT_TRUE(std::isnan(heading("GPTHS,23.34," + std::string(mode)).heading_rad)) << mode;
  }
}

TEST(NmeaHeading, HdgGivesMagneticHeadingWithTheDeviationAdded) {
  const HeadingSample both = heading("HCHDG,101.1,7.1,W,12.2,E");
  EXPECT_EQ(both.north, North::magnetic);
  EXPECT_NEAR(both.heading_rad, 94.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(both.deviation_rad, -7.1 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(both.variation_rad, 12.2 * kRadPerDeg, 1e-12);
  const HeadingSample bare = heading("HCHDG,101.1,,,7.1,W");
  EXPECT_NEAR(bare.heading_rad, 101.1 * kRadPerDeg, 1e-12);
  EXPECT_TRUE(std::isnan(bare.deviation_rad));
  EXPECT_NEAR(bare.variation_rad, -7.1 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(heading("HCHDG,1.0,3.0,W,,").heading_rad, 358.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(heading("HCHDG,359.0,3.0,E,,").heading_rad, 2.0 * kRadPerDeg, 1e-12);
}

TEST(NmeaHeading, AnEmptyHeadingIsUnknownAndAMalformedOneIsRefused) {
  EXPECT_TRUE(std::isnan(heading("GPHDT,,T").heading_rad));
  EXPECT_EQ(refused("HEHDT,nan,T"), RejectReason::field);
  EXPECT_EQ(refused("HEHDT,27x,T"), RejectReason::field);
  EXPECT_EQ(refused("HEHDT,274.07,M"), RejectReason::field);
  EXPECT_EQ(refused("HEHDT,360.1,T"), RejectReason::out_of_range);
  EXPECT_EQ(refused("HEHDT,-1.0,T"), RejectReason::out_of_range);
  EXPECT_EQ(refused("HEHDT,274.07"), RejectReason::structure);
  EXPECT_EQ(refused("HCHDG,101.1,7.1,W"), RejectReason::structure);
}

TEST(NmeaRpm, FollowsOneShaftAndKnowsWhenItIsInvalid) {
  const DecodeRun run = decode_text("rpm", sentence("IIRPM,S,1,1250.5,,A") + sentence("IIRPM,S,2,900,,A") +
                                               sentence("IIRPM,E,1,2500,,A") + sentence("IIRPM,S,1,-300,,A") +
                                               sentence("IIRPM,S,1,17,,V") + sentence("IIRPM,S,1,,,A"));
  const auto rpm = run.all<PropulsionSample>();
  ASSERT_EQ(rpm.size(), 4U);
  EXPECT_EQ(rpm[0].rpm, 1250.5);
  EXPECT_EQ(rpm[1].rpm, -300.0);
  EXPECT_TRUE(std::isnan(rpm[2].rpm));
  EXPECT_TRUE(std::isnan(rpm[3].rpm));
  EXPECT_EQ(run.totals.frames_ignored, 2U);
}

TEST(NmeaRpm, AnEngineIsFollowedUntilAShaftShowsUp) {
  const DecodeRun run = decode_text(
      "rpm", sentence("IIRPM,E,1,2500,,A") + sentence("IIRPM,S,1,1250,,A") + sentence("IIRPM,E,1,2500,,A"));
  const auto rpm = run.all<PropulsionSample>();
  ASSERT_EQ(rpm.size(), 2U);
  EXPECT_EQ(rpm[1].rpm, 1250.0);
}

TEST(NmeaRpm, RefusesWhatIsNoRate) {
  EXPECT_EQ(refused("IIRPM,X,1,1250,,A"), RejectReason::field);
  EXPECT_EQ(refused("IIRPM,S,a,1250,,A"), RejectReason::field);
  EXPECT_EQ(refused("IIRPM,S,1,inf,,A"), RejectReason::field);
  EXPECT_EQ(refused("IIRPM,S,1,999999,,A"), RejectReason::out_of_range);
  EXPECT_EQ(refused("IIRPM,S,1,1250"), RejectReason::structure);
}

TEST(NmeaFins, RudderAndSternPlaneBecomeOneSample) {
  const DecodeRun run =
      decode_text("actuator", sentence("IIRSA,10.0,A,,V") + sentence("IIXDR,A,-5.0,D,STERN,A,1.0,D,PITCH"));
  const auto fins = run.all<FinsSample>();
  ASSERT_EQ(fins.size(), 1U);
  // RSA counts bow to starboard positive; about the down axis that is a negative rotation of the rudder.
  EXPECT_NEAR(fins[0].rudder_rad, -10.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(fins[0].stern_rad, -5.0 * kRadPerDeg, 1e-12);
  EXPECT_EQ(run.samples[0].offset, 0U);
}

TEST(NmeaFins, OneXdrMayCarryBoth) {
  const auto fins = decode_text("actuator", sentence("IIXDR,A,3.0,D,rudder,A,4.0,D,Stern")).all<FinsSample>();
  ASSERT_EQ(fins.size(), 1U);
  EXPECT_NEAR(fins[0].rudder_rad, 3.0 * kRadPerDeg, 1e-12);
  EXPECT_NEAR(fins[0].stern_rad, 4.0 * kRadPerDeg, 1e-12);
}

TEST(NmeaFins, ALoneRudderSoonLeavesAtOnce) {
  auto codec = find_protocol("actuator")->make({});
  DecodeRun run;
  std::size_t fed = 0;
  for (; fed < 6; ++fed) {
    codec->feed(test::bytes_of(sentence("IIRSA," + std::to_string(fed) + ",A,,V")), run);
    if (fed >= 2) {
      EXPECT_EQ(run.samples.size(), fed + 1) << fed;
    }
  }
  for (const FinsSample& sample : run.all<FinsSample>()) EXPECT_TRUE(std::isnan(sample.stern_rad));
  // The stern plane comes to life: pairs again, nothing lost.
  codec->feed(test::bytes_of(sentence("IIXDR,A,4.0,D,STERN") + sentence("IIRSA,7,A,,V")), run);
  const auto fins = run.all<FinsSample>();
  ASSERT_EQ(fins.size(), 7U);
  EXPECT_TRUE(known(fins.back().rudder_rad) && known(fins.back().stern_rad));
}

TEST(NmeaFins, AnInvalidRudderIsUnknown) {
  const auto fins = decode_text("actuator", sentence("IIRSA,10.0,V,,V")).all<FinsSample>();
  ASSERT_EQ(fins.size(), 1U);
  EXPECT_TRUE(std::isnan(fins[0].rudder_rad));
  EXPECT_EQ(refused("IIRSA,10.0,A,1.0"), RejectReason::structure);
  EXPECT_EQ(refused("IIXDR,A,10.0,D"), RejectReason::structure);
  EXPECT_EQ(refused("IIXDR,A,10.0,P,STERN"), RejectReason::field);
  EXPECT_EQ(refused("IIXDR,A,190.0,D,STERN"), RejectReason::out_of_range);
}

TEST(NmeaFins, OtherTransducersCarryNoSample) {
  const DecodeRun run = decode_text("actuator",
                                    "$HCXDR,A,171,D,PITCH,A,-37,D,ROLL,G,367,,MAGX,G,2420,,MAGY,G,-8984,,"
                                    "MAGZ*41\r\n");
  EXPECT_EQ(run.totals.frames_ignored, 1U);
}

UsblSample usbl(const std::string& body, const CodecOptions& options = {}) {
  const DecodeRun run = decode_text("psimssb", sentence(body), options);
  EXPECT_EQ(run.samples.size(), 1U) << body;
  return run.samples.empty() ? UsblSample{} : std::get<UsblSample>(run.samples[0].sample);
}

TEST(Psimssb, NorthEastDown) {
  const DecodeRun run =
      decode_text("psimssb", "$PSIMSSB,083733.386,M17,A,,C,N,F,46.649,1.632,24.829,1.414,T,0.033681,*54\r\n");
  ASSERT_EQ(run.samples.size(), 1U);
  const auto& sample = std::get<UsblSample>(run.samples[0].sample);
  EXPECT_EQ(sample.frame, UsblFrame::ned);
  EXPECT_EQ(sample.transponder.view(), "M17");
  EXPECT_DOUBLE_EQ(sample.relative_m[0], 46.649);
  EXPECT_DOUBLE_EQ(sample.relative_m[1], 1.632);
  EXPECT_DOUBLE_EQ(sample.relative_m[2], 24.829);
  EXPECT_DOUBLE_EQ(sample.sigma_m, 1.414);
  EXPECT_DOUBLE_EQ(sample.travel_time_s, 0.033681);
  EXPECT_EQ(run.samples[0].time.time_of_day_ns,
            (8 * 3600 + 37 * 60 + 33) * kNsPerSecond + 386 * kNsPerMillisecond);
}

TEST(Psimssb, VesselAndEastAxesAndRadians) {
  const UsblSample vessel = usbl("PSIMSSB,180554.432,M44,A,,C,H,M,3.0,40.0,34.0,0.5,T,0.05,");
  EXPECT_EQ(vessel.frame, UsblFrame::vessel_frd);
  EXPECT_DOUBLE_EQ(vessel.relative_m[0], 40.0);  // y is forward
  EXPECT_DOUBLE_EQ(vessel.relative_m[1], 3.0);   // x is starboard
  const UsblSample east = usbl("PSIMSSB,180554.432,M44,A,,C,E,M,3.0,40.0,34.0,0.5,N,,");
  EXPECT_EQ(east.frame, UsblFrame::ned);
  EXPECT_DOUBLE_EQ(east.relative_m[0], 40.0);
  EXPECT_TRUE(std::isnan(east.travel_time_s));
  const UsblSample geodetic = usbl("PSIMSSB,180554.432,M44,A,,R,G,M,0.635,2.224,34.0,0.5,T,0.05,");
  EXPECT_EQ(geodetic.frame, UsblFrame::geodetic);
  EXPECT_DOUBLE_EQ(geodetic.latitude_rad, 0.635);
  EXPECT_DOUBLE_EQ(geodetic.longitude_rad, 2.224);
  EXPECT_DOUBLE_EQ(geodetic.depth_m, 34.0);
}

TEST(Psimssb, NoReplyIsNoPositionWhateverTheStatusSays) {
  for (const char* line : {"$PSIMSSB,083733.036,M17,A,NRy,C,N,F,0.000,0.000,0.000,20.000,T,0.003731,*08\r\n",
                           "$PSIMSSB,093933.055,M17,A,NRy,C,N,F,13.281,-1.978,0.422,2.236,T,0.008391,*27\r\n",
                           "$PSIMSSB,094532.523,M17,V,NRy,C,N,M,,,,,T,0.002245,*25\r\n"}) {
    const DecodeRun run = decode_text("psimssb", line);
    ASSERT_EQ(run.samples.size(), 1U) << line;
    const auto& sample = std::get<UsblSample>(run.samples[0].sample);
    for (const double component : sample.relative_m) EXPECT_TRUE(std::isnan(component)) << line;
    EXPECT_TRUE(std::isnan(sample.sigma_m)) << line;
    EXPECT_TRUE(known(sample.travel_time_s)) << line;
  }
}

TEST(Psimssb, TheSigmaHasAFloor) {
  CodecOptions options;
  options.usbl.sigma_floor_m = 1.5;
  EXPECT_EQ(usbl("PSIMSSB,180554.432,M44,A,,C,N,M,3.0,40.0,34.0,0.072,T,0.05,", options).sigma_m, 1.5);
  EXPECT_EQ(usbl("PSIMSSB,180554.432,M44,A,,C,N,M,3.0,40.0,34.0,2.5,T,0.05,", options).sigma_m, 2.5);
}

// A line as recorded on a ship of research that tracked a submersible.
constexpr const char* kSubmersible =
    "$PSONLLD,170004.53,ALVIN 914,A,28.8114807,-87.80925696,1951.156,13.96,13.96,0.00,2.62,,,,*6F\r\n";

UsblSample place(const std::string& text, const CodecOptions& options = {}) {
  const DecodeRun run = decode_text("psonlld", text, options);
  EXPECT_EQ(run.samples.size(), 1U) << text;
  return run.samples.empty() ? UsblSample{} : std::get<UsblSample>(run.samples[0].sample);
}

RejectReason place_refused(const std::string& body) {
  const DecodeRun run = decode_text("psonlld", sentence(body));
  EXPECT_TRUE(run.samples.empty()) << body;
  EXPECT_EQ(run.rejected.size(), 1U) << body;
  return run.rejected.empty() ? RejectReason::checksum : run.rejected[0].reason;
}

TEST(Psonlld, APlaceWithItsBeaconAndErrorEllipse) {
  for (const char* protocol : {"psonlld", "sonardyne", "nmea0183"}) {
    const DecodeRun run = decode_text(protocol, kSubmersible);
    ASSERT_EQ(run.samples.size(), 1U) << protocol;
    const auto& sample = std::get<UsblSample>(run.samples[0].sample);
    EXPECT_EQ(sample.frame, UsblFrame::geodetic);
    EXPECT_EQ(sample.transponder.view(), "ALVIN 914");
    EXPECT_DOUBLE_EQ(sample.latitude_rad * kDegPerRad, 28.8114807);
    EXPECT_DOUBLE_EQ(sample.longitude_rad * kDegPerRad, -87.80925696);
    EXPECT_DOUBLE_EQ(sample.depth_m, 1951.156);
    EXPECT_DOUBLE_EQ(sample.sigma_m, 13.96);
    EXPECT_EQ(run.samples[0].time.time_of_day_ns, (17 * 3600 + 4) * kNsPerSecond + 530 * kNsPerMillisecond);
  }
}

TEST(Psonlld, TheSigmaIsThatOfTheLargerSemiAxisWithAFloor) {
  const std::string body = "PSONLLD,170004.53,24,A,50.02495,8.873323,425.3,";
  CodecOptions options;
  options.usbl.sigma_floor_m = 0.5;
  EXPECT_EQ(place(sentence(body + "3.0,1.0,30.0,0.5,,,,"), options).sigma_m, 3.0);
  EXPECT_EQ(place(sentence(body + "0.1,0.3,30.0,0.5,,,,"), options).sigma_m, 0.5);
  EXPECT_EQ(place(sentence(body + "2.0,,,,,,,"), options).sigma_m, 2.0);
  EXPECT_TRUE(std::isnan(place(sentence(body + "0.00,0.00,0.00,0.00,,,,"), options).sigma_m));
  EXPECT_TRUE(std::isnan(place(sentence(body + ",,,,,,,"), options).sigma_m));
}

TEST(Psonlld, AFixThatIsNotValidHasNoPlace) {
  const UsblSample sample =
      place(sentence("PSONLLD,170004.53,24,V,50.02495,8.873323,425.3,3.0,1.0,30.0,0.5,,,,"));
  EXPECT_EQ(sample.transponder.view(), "24");
  EXPECT_TRUE(std::isnan(sample.latitude_rad));
  EXPECT_TRUE(std::isnan(sample.depth_m));
  EXPECT_TRUE(std::isnan(sample.sigma_m));
}

TEST(Psonlld, WhatCannotBeIsRefused) {
  EXPECT_EQ(place_refused("PSONLLD,170004.53,24,A,50.02495,8.873323"), RejectReason::structure);
  EXPECT_EQ(place_refused("PSONLLD,170004.53,24,A,95.0,8.8,425.3,3.0,1.0,30.0,0.5,,,,"),
            RejectReason::out_of_range);
  EXPECT_EQ(place_refused("PSONLLD,170004.53,24,A,5O.0,8.8,425.3,3.0,1.0,30.0,0.5,,,,"), RejectReason::field);
  EXPECT_EQ(place_refused("PSONLLD,170004.53,24,X,50.0,8.8,425.3,3.0,1.0,30.0,0.5,,,,"), RejectReason::field);
  EXPECT_EQ(place_refused("PSONLLD,250004.53,24,A,50.0,8.8,425.3,3.0,1.0,30.0,0.5,,,,"),
            RejectReason::out_of_range);
}

TEST(Psonlld, OtherSentencesCarryNoSample) {
  const DecodeRun run = decode_text(
      "psonlld",
      "$PSONALL,Ship 1,CRP,134446.175,650879.00,5688874.16,0.00,180.00,,G,0.00,0.00,,0.109,0.001*51\r\n" +
          sentence("PSIMSSB,180554.432,M44,A,,C,N,M,3.0,40.0,34.0,0.5,T,0.05,"));
  EXPECT_TRUE(run.samples.empty());
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.frames_ignored, 2U);
}

TEST(Psimssb, OtherCoordinatesAndOtherSentencesCarryNoSample) {
  const DecodeRun run = decode_text(
      "psimssb",
      sentence("PSIMSSB,180554.432,M44,A,,U,N,M,4000000.0,500000.0,34.0,0.5,T,0.05,") +
          sentence("PSIMSSB,180554.432,M44,A,,P,H,M,10.0,20.0,34.0,0.5,T,0.05,") +
          "$PSIMSNS,075617.446,,1,1,-1.27,-1.13,-0.04,250.87,,a0,0.000,,M121*59\r\n$GPHDT,25.50,T*37\r\n");
  EXPECT_TRUE(run.samples.empty());
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.frames_ignored, 4U);
}

TEST(Psimssb, TheShipOfTheStreamGoesIntoItsRelativeFixes) {
  const std::string ship = sentence("GPGGA,180554.00,4000.0000000,N,00130.0000000,E,1,10,1.0,3.0,M,0.0,M,,") +
                           sentence("HEHDT,90.0,T");
  const std::string vessel = sentence("PSIMSSB,180554.432,M44,A,,C,H,M,3.0,40.0,34.0,0.5,T,0.05,");
  const auto decoded = [](const std::string& text) {
    std::vector<UsblSample> out;
    for (const auto& one : decode_text("psimssb", text).samples)
      out.push_back(std::get<UsblSample>(one.sample));
    return out;
  };
  const auto placed = decoded(ship + vessel);
  ASSERT_EQ(placed.size(), 1U);
  EXPECT_NEAR(placed[0].station_latitude_rad, 0.69813170, 1e-8);
  EXPECT_NEAR(placed[0].station_longitude_rad, 0.02617994, 1e-8);
  EXPECT_NEAR(placed[0].station_rpy_rad[2], 1.57079633, 1e-8);
  EXPECT_EQ(placed[0].station_rpy_rad[0], 0.0);
  // Of another time, without fix, or of nobody.
  const std::string late = sentence("PSIMSSB,180557.432,M44,A,,C,H,M,3.0,40.0,34.0,0.5,T,0.05,");
  EXPECT_FALSE(known(decoded(ship + late).at(0).station_latitude_rad));
  const std::string lost = sentence("GPGGA,180554.00,,,,,0,00,,,M,,M,,");
  EXPECT_FALSE(known(decoded(ship + lost + vessel).at(0).station_latitude_rad));
  EXPECT_FALSE(known(decoded(vessel).at(0).station_rpy_rad[2]));
  // A heading that is not renewed is not believed for ever.
  EXPECT_FALSE(known(decoded(ship + vessel + vessel + vessel + vessel).at(3).station_rpy_rad[2]));
  // Midnight lies between the two.
  const std::string midnight =
      sentence("GPGGA,235959.50,4000.0000000,N,00130.0000000,E,1,10,1.0,3.0,M,0.0,M,,") +
      sentence("PSIMSSB,000000.400,M44,A,,C,N,M,3.0,40.0,34.0,0.5,T,0.05,");
  EXPECT_TRUE(known(decoded(midnight).at(0).station_latitude_rad));
}

TEST(Psimssb, RefusesMalformedFixes) {
  EXPECT_EQ(refused("PSIMSSB,180554.432,M44,X,,C,N,M,3.0,40.0,34.0,0.5,T,0.05,"), RejectReason::field);
  EXPECT_EQ(refused("PSIMSSB,180554.432,M44,A,,C,N,M,3.0,4O.0,34.0,0.5,T,0.05,"), RejectReason::field);
  EXPECT_EQ(refused("PSIMSSB,180554.432,M44,A,,C,N,M,3.0,1e9,34.0,0.5,T,0.05,"), RejectReason::field);
  EXPECT_EQ(refused("PSIMSSB,180554.432,M44,A,,C,N,M,3.0,999999999,34.0,0.5,T,0.05,"),
            RejectReason::out_of_range);
  EXPECT_EQ(refused("PSIMSSB,180554.432,M44,A,,R,G,M,4.0,2.0,34.0,0.5,T,0.05,"), RejectReason::out_of_range);
  EXPECT_EQ(refused("PSIMSSB,180554.432,M44,A,,C,N,M,3.0"), RejectReason::structure);
}

TEST(Psimssb, AnEmptyChecksumNeedsPermission) {
  const std::string line = "$PSIMSSB,083733.386,M17,A,,C,N,F,46.649,1.632,24.829,1.414,T,0.033681,*\r\n";
  EXPECT_EQ(decode_text("psimssb", line).rejected.at(0).reason, RejectReason::no_checksum);
  CodecOptions lenient;
  lenient.require_checksum = false;
  EXPECT_EQ(decode_text("psimssb", line, lenient).samples.size(), 1U);
}

}  // namespace
}  // namespace fathom::codec

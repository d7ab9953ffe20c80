// Headings of attitude sentences: of compasses, two-antenna receivers and inertial systems.

#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "nmea_text.hpp"
#include "support/paths.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;
using test::sentence;

Decoded attitude(const std::string& text, const CodecOptions& options = {}) {
  const DecodeRun run = decode_text("attitude", text, options);
  EXPECT_EQ(run.samples.size(), 1U) << text;
  EXPECT_TRUE(run.rejected.empty()) << text;
  EXPECT_EQ(run.totals.skipped_bytes, 0U) << text;
  return run.samples.size() == 1 ? run.samples[0] : Decoded{HeadingSample{}, {}};
}

HeadingSample heading_of(const std::string& text, const CodecOptions& options = {}) {
  return std::get<HeadingSample>(attitude(text, options).sample);
}

bool has_heading(const std::string& body) {
  return known(heading_of(sentence(body)).heading_rad);
}

RejectReason attitude_refused(const std::string& body) {
  const DecodeRun run = decode_text("nmea_attitude", sentence(body));
  EXPECT_EQ(run.rejected.size(), 1U) << body;
  EXPECT_TRUE(run.samples.empty()) << body;
  return run.rejected.empty() ? RejectReason::truncated : run.rejected[0].reason;
}

void expect_heading(const std::string& text, double heading_deg, double sigma_deg, North north) {
  const HeadingSample got = heading_of(text);
  EXPECT_NEAR(got.heading_rad, heading_deg * kRadPerDeg, 1e-12) << text;
  EXPECT_EQ(known(got.sigma_rad), known(sigma_deg)) << text;
  if (known(sigma_deg)) {
    EXPECT_NEAR(got.sigma_rad, sigma_deg * kRadPerDeg, 1e-12) << text;
  }
  EXPECT_EQ(got.north, north) << text;
  EXPECT_FALSE(known(got.variation_rad)) << text;
}

// PASHR of NovAtel's manual, of a POS MV at sea (UHDAS, University of Hawaii), of an OxTS unit, and of other
// recordings.
TEST(NmeaAttitude, PashrIsTrueHeadingWithItsSigma) {
  const auto expect = [](const std::string& text, double heading_deg, double sigma_deg) {
    expect_heading(text + "\r\n", heading_deg, sigma_deg, North::true_north);
  };
  expect("$PASHR,163029.000,158.09,T,-0.30,+0.31,+0.01,0.029,0.029,0.059,1,1*3B", 158.09, 0.059);
  expect("$PASHR,183944.821,74.52,T,-1.63,1.51,0.14,0.020,0.020,0.012,2,1*05", 74.52, 0.012);
  expect("$PASHR,204132.000,010.51,T,+00.39,-00.79,-00.84,0.151,0.075,0.555,1,0*03", 10.51, 0.555);
  expect("$PASHR,145719.272,252.41,T,1.22,0.48,0.01,0.090,0.090,0.116,2,1*11", 252.41, 0.116);
  expect("$PASHR,125648.280,322.905,T,0.621,-0.114,,0.034,0.034,0.450,2,3*1B", 322.905, 0.450);
  expect("$PASHR,154155.50,153.17,T,9.68,2.29,-0.07,0.502,0.502,0.959,1*19", 153.17, 0.959);
  // Numbers padded with blanks.
  expect("$PASHR,123816.80,312.95,T, -0.83,-0.42, -0.01,0.234,0.224,0.298,2,1*0B", 312.95, 0.298);
  const Decoded decoded = attitude("$PASHR,183944.821,74.52,T,-1.63,1.51,0.14,0.020,0.020,0.012,2,1*05\r\n");
  EXPECT_EQ(decoded.time.time_of_day_ns, (18 * 3600 + 39 * 60 + 44) * kNsPerSecond + 821 * kNsPerMillisecond);
  EXPECT_FALSE(decoded.time.utc_ns);
}

TEST(NmeaAttitude, PashrWithoutSolutionHasNoHeading) {
  EXPECT_FALSE(known(
      heading_of("$PASHR,135920.00,0.00,T,000.00,0.00,000.00,0.000,0.000,0.000,0,0*2C\r\n").heading_rad));
  EXPECT_FALSE(has_heading("PASHR,,,,,,,,,,0,0"));
  EXPECT_FALSE(has_heading("PASHR,135920.00,,T,,,,,,,2,1"));
  // No fix and nothing of an inertial system; no alignment and no accuracy; an accuracy that says nothing.
  EXPECT_FALSE(has_heading("PASHR,135920.00,12.00,T,1.00,0.00,0.00,0.020,0.020,0.500,0"));
  EXPECT_FALSE(has_heading("PASHR,135920.00,12.00,T,1.00,0.00,0.00,0.020,0.020,0.500,0,0"));
  EXPECT_FALSE(has_heading("PASHR,135920.00,0.00,T,0.00,0.00,0.00,0.000,0.000,0.000,1,0"));
  EXPECT_FALSE(has_heading("PASHR,135920.00,12.00,T,1.00,0.00,0.00,0.020,0.020,180.000,2,1"));
  // An aligned system without fix is under water; one of two antennas alone says how good it is.
  EXPECT_TRUE(has_heading("PASHR,135920.00,12.00,T,1.00,0.00,0.00,0.020,0.020,0.500,0,1"));
  EXPECT_TRUE(has_heading("PASHR,135920.00,12.00,T,1.00,0.00,0.00,0.020,0.020,0.500,4,0"));
  const HeadingSample unknown = heading_of(sentence("PASHR,135920.00,12.00,T,1.0,0.0,0.0,0.0,0.0,0.000,2,1"));
  EXPECT_TRUE(known(unknown.heading_rad));
  EXPECT_FALSE(known(unknown.sigma_rad)) << "an accuracy of 0 is none";
}

TEST(NmeaAttitude, AshtechsOwnSentencesCarryNoSample) {
  const DecodeRun run =
      decode_text("attitude", "$PASHR,POS,0,02,174637.07,,,,,,,,,,,,,,D06E*08\r\n" +
                                  sentence("PASHR,ATT,310080.0,086.42,+000.22,-001.01,0.0013,0.0156,0") +
                                  sentence("PASHR"));
  EXPECT_TRUE(run.samples.empty());
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.frames_ignored, 3U);
}

TEST(NmeaAttitude, PsatHprIsTrueHeading) {
  // As receivers sent them.
  expect_heading("$PSAT,HPR,102143.00,356.881,-0.387,-0.4,N*1E\r\n", 356.881, kUnknown, North::true_north);
  expect_heading("$PSAT,HPR,044551.80,161.54,-2.84,1.4,N*3A\r\n", 161.54, kUnknown, North::true_north);
  expect_heading(sentence("PSAT,HPR,000002.00,184.19,,-1.73,G"), 184.19, kUnknown, North::true_north);
  EXPECT_FALSE(has_heading("PSAT,HPR,000002.00,,,,N"));
  EXPECT_FALSE(has_heading("PSAT,HPR,,,,,"));
  EXPECT_EQ(attitude(sentence("PSAT,HPR,000002.50,184.19,,-1.73,N")).time.time_of_day_ns,
            2'500 * kNsPerMillisecond);
  const DecodeRun others =
      decode_text("attitude", sentence("PSAT,GBS,111.0,0.1,0.1,0.1,,,,0") + sentence("PSAT,INTLT,0.1,0.2"));
  EXPECT_TRUE(others.samples.empty());
  EXPECT_EQ(others.totals.frames_ignored, 2U);
}

// Of the user's guide of the HMR3000, section 3.12, which leaves the heading empty under an alarm.
TEST(NmeaAttitude, PtnthprIsMagneticHeadingUnlessUnderAlarm) {
  const auto expect = [](const std::string& text, double heading_deg) {
    expect_heading(text + "\r\n", heading_deg, kUnknown, North::magnetic);
  };
  expect("$PTNTHPR,59.6,N,-0.2,N,-3.0,N*0F", 59.6);
  expect("$PTNTHPR,72.9,N,-1.6,N,-29.6,O*33", 72.9);
  expect("$PTNTHPR,85.9,N,-0.9,N,0.8,N*2C", 85.9);
  for (const char* text : {"$PTNTHPR,,N,-1.5,N,,P*03\r\n", "$PTNTHPR,,P,0.3,N,0.1,N*06\r\n"})
    EXPECT_FALSE(known(heading_of(text).heading_rad)) << text;
  for (const char* status : {"M", "N", "O"})
    EXPECT_TRUE(has_heading("PTNTHPR,59.6," + std::string(status) + ",-0.2,N,-3.0,N")) << status;
  for (const char* status : {"L", "P", "C", "H", "V"}) {
    EXPECT_FALSE(has_heading("PTNTHPR,59.6," + std::string(status) + ",-0.2,N,-3.0,N")) << status;
    EXPECT_FALSE(has_heading("PTNTHPR,59.6,N,-0.2," + std::string(status) + ",-3.0,N")) << status;
    EXPECT_FALSE(has_heading("PTNTHPR,59.6,N,-0.2,N,-3.0," + std::string(status))) << status;
  }
}

// Of the users guide of the OS5000, and as devices sent them.
TEST(NmeaAttitude, OceanServerIsMagneticHeadingInBothOfItsForms) {
  const auto expect = [](const std::string& text, double heading_deg) {
    expect_heading(text + "\r\n", heading_deg, kUnknown, North::magnetic);
  };
  expect("$C320.5P0.2R-18.3T19.0*3C", 320.5);
  expect("$C212.4P2.5R-14.0T28.4Mx107977.90My-79422.00Mz173.27Ax0.045Ay-0.245Az0.977*3A", 212.4);
  expect(sentence("C328.3P28.4R-12.4T21.1D21.01").substr(0, 32), 328.3);
  expect(sentence("C7").substr(0, 6), 7.0);
  expect("$OHPR,237.7,-14.3,175.5,30.1*2B", 237.7);
  expect("$OHPR,78.8,-0.5,-1.4,-0.009,-0.025,0.976*34", 78.8);
  EXPECT_FALSE(has_heading("OHPR,,,,,,,,"));
}

TEST(NmeaAttitude, PrdidIsTrueHeadingIfItHasOne) {
  expect_heading(sentence("PRDID,-1.25,+0.50,359.99"), 359.99, kUnknown, North::true_north);
  EXPECT_EQ(heading_of(sentence("PRDID,-1.25,+0.50,360.00")).heading_rad, 0.0);
  // Of Norwegian Subsea's manual, which prints a wrong checksum: a motion sensor has none.
  EXPECT_FALSE(has_heading("PRDID,-000.49,-000.14,"));
}

TEST(NmeaAttitude, TheNorthThatIsToldGoesBeforeTheUsualOne) {
  CodecOptions options;
  for (const North north : {North::true_north, North::magnetic}) {
    options.untold_north = north;
    for (const char* body : {"PTNTHPR,59.6,N,-0.2,N,-3.0,N", "OHPR,78.8,-0.5,-1.4", "C320.5P0.2R-18.3",
                             "PRDID,-1.25,+0.50,359.99"})
      EXPECT_EQ(heading_of(sentence(body), options).north, north) << body;
    for (const char* body : {"PASHR,163029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1",
                             "PSAT,HPR,000002.00,184.19,,-1.73,N"})
      EXPECT_EQ(heading_of(sentence(body), options).north, North::true_north) << body;
  }
}

TEST(NmeaAttitude, WhatCannotBeIsRefused) {
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.09,T,-0.30"), RejectReason::structure);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1,1"),
            RejectReason::structure);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.09,M,-0.3,0.3,0.0,0.029,0.029,0.059,1,1"),
            RejectReason::field);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.O9,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1"),
            RejectReason::field);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,A,1"),
            RejectReason::field);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,-0.059,1,1"),
            RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,360.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1"),
            RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("PASHR,243029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1"),
            RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.09,T,-0.3,90.3,0.0,0.029,0.029,0.059,1,1"),
            RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("PASHR,163029.000,158.09,T,-180.3,0.3,0.0,0.029,0.029,0.059,1,1"),
            RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("PSAT,HPR,000002.00,184.19,,-1.73"), RejectReason::structure);
  EXPECT_EQ(attitude_refused("PSAT,HPR,000002.00,184.19,,-1.73,X"), RejectReason::field);
  EXPECT_EQ(attitude_refused("PSAT,HPR,000002.00,-4.19,,-1.73,N"), RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("PTNTHPR,59.6,N,-0.2,N,-3.0"), RejectReason::structure);
  EXPECT_EQ(attitude_refused("PTNTHPR,59.6,Q,-0.2,N,-3.0,N"), RejectReason::field);
  EXPECT_EQ(attitude_refused("PTNTHPR,1600.0,N,-3.6,N,-53.3,N"), RejectReason::out_of_range) << "mils";
  EXPECT_EQ(attitude_refused("OHPR,78.8,-0.5"), RejectReason::structure);
  EXPECT_EQ(attitude_refused("OHPR,78.8,-0.5,-1.4,warm"), RejectReason::field);
  EXPECT_EQ(attitude_refused("OHPR,78.8,-90.5,-1.4"), RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("PRDID,-1.25,+0.50"), RejectReason::structure);
  EXPECT_EQ(attitude_refused("PRDID,-91.25,+0.50,10.0"), RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("C360.5P0.2R-18.3"), RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("C320.5P90.2R-18.3"), RejectReason::out_of_range);
  EXPECT_EQ(attitude_refused("C320.5P0.2R-18.3T1-9"), RejectReason::field);
  EXPECT_EQ(attitude_refused("C320.5P0.2R-18.3P0.2"), RejectReason::structure);
  EXPECT_EQ(attitude_refused("C320.5P0.2R"), RejectReason::structure);
  EXPECT_EQ(attitude_refused("C320.5,P0.2"), RejectReason::structure);
  std::string long_one = "C320.5";
  for (int i = 0; i < 200; ++i) long_one += "T1";
  EXPECT_EQ(attitude_refused(long_one), RejectReason::structure);
}

TEST(NmeaAttitude, ASentenceIsWorthItsChecksum) {
  for (const char* text : {"$C320.5P0.2R-18.3T19.0*3D\r\n", "$OHPR,237.7,-14.3,175.5,30.1*2C\r\n"}) {
    const DecodeRun run = decode_text("attitude", text);
    EXPECT_TRUE(run.samples.empty()) << text;
    ASSERT_EQ(run.rejected.size(), 1U) << text;
    EXPECT_EQ(run.rejected[0].reason, RejectReason::checksum) << text;
  }
  CodecOptions options;
  for (const char* text : {"$C320.5P0.2R-18.3T19.0\r\n", "$OHPR,237.7,-14.3,175.5,30.1\r\n"}) {
    options.require_checksum = true;
    const DecodeRun run = decode_text("attitude", text, options);
    ASSERT_EQ(run.rejected.size(), 1U) << text;
    EXPECT_EQ(run.rejected[0].reason, RejectReason::no_checksum) << text;
    options.require_checksum = false;
    EXPECT_TRUE(known(heading_of(text, options).heading_rad)) << text;
  }
}

TEST(NmeaAttitude, EachSentenceThatManualsAndRecordingsShowIsRead) {
  std::ifstream in(test::vectors_dir() + "/nmea_attitude/published.nmea", std::ios::binary);
  int headings = 0;
  int unknown = 0;
  for (std::string line; std::getline(in, line);)
    ++(known(heading_of(line + "\n").heading_rad) ? headings : unknown);
  EXPECT_EQ(headings, 21);
  EXPECT_EQ(unknown, 3);
}

TEST(NmeaAttitude, OtherHeadingsOfTheInstrumentDoNotCountBesides) {
  const std::string pashr = sentence("PASHR,163029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1");
  const std::string hdt =
      sentence("HEHDT,158.09,T") + sentence("GPTHS,158.09,A") + sentence("HCHDG,150,,,8,E");
  const DecodeRun own = decode_text("nmea_attitude", hdt + pashr + hdt);
  EXPECT_EQ(own.samples.size(), 1U);
  EXPECT_EQ(own.totals.frames_ignored, 6U);
  const DecodeRun other = decode_text("nmea0183", hdt + pashr + "$C320.5P0.2R-18.3T19.0*3C\r\n");
  EXPECT_EQ(other.samples.size(), 3U);
}

TEST(NmeaAttitude, OfSeveralSentencesTheBestIsFollowed) {
  const std::string pashr = sentence("PASHR,163029.000,158.09,T,-0.3,0.3,0.0,0.029,0.029,0.059,1,1");
  const std::string none = sentence("PASHR,163029.000,,T,,,,,,,0,0");
  const std::string psat = sentence("PSAT,HPR,163029.00,158.12,,-0.3,N");
  const auto sigmas = [](const std::string& text) {
    std::string out;
    for (const HeadingSample& one : decode_text("attitude", text).all<HeadingSample>())
      out += !known(one.heading_rad) ? '-' : known(one.sigma_rad) ? 'A' : 'H';
    return out;
  };
  EXPECT_EQ(sigmas(psat + psat + pashr + psat + pashr + psat), "HHAA");
  EXPECT_EQ(sigmas(psat + none + psat + none), "HH") << "a better one without heading is no better";
  // The better one has fallen silent, or has no heading any more: the other takes over until it is back.
  std::string many;
  for (int i = 0; i < 101; ++i) many += psat;
  EXPECT_EQ(sigmas(pashr + many + none + pashr + psat), "AHHA");
  EXPECT_EQ(sigmas(none + many), "-HH");
}

}  // namespace
}  // namespace fathom::codec

// One sample per epoch: what joins, when it leaves, what its time is.

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

TimeNs utc(int year, int month, int day, int hour, int minute, int second) {
  return *from_civil(
      {.year = year, .month = month, .day = day, .hour = hour, .minute = minute, .second = second});
}

std::string gga(const std::string& time, const std::string& quality = "1") {
  return sentence("GPGGA," + time + ",4807.038,N,01131.000,E," + quality + ",08,0.9,545.4,M,46.9,M,,");
}
std::string rmc(const std::string& time, const std::string& date, const std::string& tail = ",,,A") {
  return sentence("GPRMC," + time + ",A,4807.038,N,01131.000,E,010.0,090.0," + date + tail);
}
std::string vtg() {
  return sentence("GPVTG,090.0,T,,M,010.0,N,018.5,K,A");
}
std::string gst(const std::string& time) {
  return sentence("GPGST," + time + ",,,,,1.5,2.5,4.0");
}
std::string zda(const std::string& time, const std::string& date) {
  return sentence("GPZDA," + time + "," + date + ",00,00");
}

std::vector<GpsSample> fixes(const DecodeRun& run) {
  return run.all<GpsSample>();
}

/// Counts samples as the stream arrives, sentence by sentence.
class Stream {
 public:
  std::size_t samples_after(const std::string& text) {
    codec_->feed(test::bytes_of(text), run);
    return run.samples.size();
  }
  DecodeRun run;

 private:
  std::unique_ptr<Codec> codec_ = find_protocol("nmea0183")->make({});
};

TEST(NmeaGps, OneEpochFromFourSentences) {
  const DecodeRun run =
      decode_text("nmea0183", gga("123519.5") + rmc("123519.50", "230394") + vtg() + gst("123519.500"));
  ASSERT_EQ(run.samples.size(), 1U);
  const GpsSample gps = fixes(run)[0];
  EXPECT_EQ(gps.fix, GpsFix::fix_3d);
  EXPECT_EQ(gps.satellites, 8);
  EXPECT_DOUBLE_EQ(gps.hdop, 0.9);
  EXPECT_NEAR(gps.latitude_rad, (48.0 + 7.038 / 60.0) * kRadPerDeg, 1e-12);
  EXPECT_NEAR(gps.longitude_rad, (11.0 + 31.0 / 60.0) * kRadPerDeg, 1e-12);
  EXPECT_DOUBLE_EQ(gps.altitude_msl_m, 545.4);
  EXPECT_NEAR(gps.altitude_m, 545.4 + 46.9, 1e-9);
  EXPECT_NEAR(gps.velocity_N_m_s[0], 0.0, 1e-12);
  EXPECT_NEAR(gps.velocity_N_m_s[1], 10.0 * 1852.0 / 3600.0, 1e-12);
  EXPECT_TRUE(std::isnan(gps.velocity_N_m_s[2]));
  EXPECT_DOUBLE_EQ(gps.position_sigma_N_m[0], 1.5);
  EXPECT_DOUBLE_EQ(gps.position_sigma_N_m[1], 2.5);
  EXPECT_DOUBLE_EQ(gps.position_sigma_N_m[2], 4.0);
  EXPECT_EQ(run.samples[0].time.utc_ns, utc(1994, 3, 23, 12, 35, 19) + kNsPerSecond / 2);
  EXPECT_EQ(run.samples[0].offset, 0U);
}

TEST(NmeaGps, TheCycleIsLearnedAndThenTheLastSentenceDelivers) {
  Stream stream;
  for (int second = 0; second < 2; ++second) {
    const std::string time = "12350" + std::to_string(second);
    (void)stream.samples_after(gga(time) + rmc(time, "010120") + vtg() + gst(time));
  }
  // The second epoch is still open: nobody knows yet that GST was its last sentence.
  EXPECT_EQ(stream.run.samples.size(), 1U);
  for (int second = 2; second < 6; ++second) {
    const std::string time = "12350" + std::to_string(second);
    const auto before = static_cast<std::size_t>(second);
    EXPECT_EQ(stream.samples_after(gga(time)), before);
    EXPECT_EQ(stream.samples_after(rmc(time, "010120")), before);
    EXPECT_EQ(stream.samples_after(vtg()), before);
    EXPECT_EQ(stream.samples_after(gst(time)), before + 1);
  }
}

TEST(NmeaGps, ASentenceThatComesOnlyNowAndThenIsNotLost) {
  // Position five times a second, RMC once.
  std::string text;
  for (int i = 0; i < 50; ++i) {
    const std::string time =
        "1235" + std::string(i / 5 < 10 ? "0" : "") + std::to_string(i / 5) + "." + std::to_string(i % 5 * 2);
    text += gga(time);
    if (i % 5 == 0) text += rmc(time, "010120");
  }
  const std::vector<GpsSample> gps = fixes(decode_text("nmea0183", text));
  ASSERT_EQ(gps.size(), 50U);
  for (std::size_t i = 0; i < gps.size(); ++i) {
    EXPECT_EQ(known(gps[i].velocity_N_m_s[0]), i % 5 == 0) << i;
  }
}

TEST(NmeaGps, ADroppedSentenceDelaysItsEpochAndLosesNothingElse) {
  std::string text;
  for (int second = 0; second < 10; ++second) {
    const std::string time = "12350" + std::to_string(second);
    text += gga(time);
    if (second != 6) text += rmc(time, "010120");
  }
  const std::vector<GpsSample> gps = fixes(decode_text("nmea0183", text));
  ASSERT_EQ(gps.size(), 10U);
  EXPECT_FALSE(known(gps[6].velocity_N_m_s[1]));
  EXPECT_TRUE(known(gps[7].velocity_N_m_s[1]));
}

TEST(NmeaGps, WithoutFixTheReceiverIsSeenAliveAndSaysNothing) {
  const DecodeRun run = decode_text("nmea0183",
                                    "$GNRMC,,V,,,,,,,,,,N,V*37\r\n$GNVTG,,,,,,,,,N*2E\r\n"
                                    "$GNGGA,,,,,,0,00,99.99,,,,,,*56\r\n");
  ASSERT_EQ(run.samples.size(), 1U);
  const GpsSample gps = fixes(run)[0];
  EXPECT_EQ(gps.fix, GpsFix::none);
  EXPECT_EQ(gps.satellites, 0);
  EXPECT_TRUE(std::isnan(gps.latitude_rad));
  EXPECT_TRUE(std::isnan(gps.altitude_m));
  EXPECT_TRUE(std::isnan(gps.velocity_N_m_s[0]));
  EXPECT_FALSE(run.samples[0].time.utc_ns.has_value());
  EXPECT_FALSE(run.samples[0].time.time_of_day_ns.has_value());
}

TEST(NmeaGps, APositionWithoutFixIsNotPassedOn) {
  const DecodeRun run = decode_text("nmea0183", gga("120000", "0"));
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(fixes(run)[0].fix, GpsFix::none);
  EXPECT_TRUE(std::isnan(fixes(run)[0].latitude_rad));
}

TEST(NmeaGps, RmcStatusVoidTakesTheFixAway) {
  const std::string void_rmc = sentence("GPRMC,120000,V,4807.038,N,01131.000,E,010.0,090.0,010120,,,A");
  const DecodeRun run = decode_text("nmea0183", gga("120000") + void_rmc);
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(fixes(run)[0].fix, GpsFix::none);
}

TEST(NmeaGps, EstimatedAndInvalidModesOfRmc) {
  EXPECT_EQ(fixes(decode_text("nmea0183", gga("120000") + rmc("120000", "010120", ",,,E")))[0].fix,
            GpsFix::dead_reckoning);
  EXPECT_EQ(fixes(decode_text("nmea0183", gga("120000") + rmc("120000", "010120", ",,,N")))[0].fix,
            GpsFix::none);
  // The last field of version 4.1, V, says that no navigational status is given.
  EXPECT_EQ(fixes(decode_text("nmea0183", gga("120000") + rmc("120000", "010120", ",,,A,V")))[0].fix,
            GpsFix::fix_3d);
  EXPECT_EQ(fixes(decode_text("nmea0183", rmc("120000", "010120", ",,,D")))[0].fix, GpsFix::differential);
  EXPECT_EQ(fixes(decode_text("nmea0183", rmc("120000", "010120", ",,")))[0].fix, GpsFix::fix_2d);
}

TEST(NmeaGps, QualityOfGga) {
  const std::vector<std::pair<std::string, GpsFix>> cases{
      {"0", GpsFix::none},           {"1", GpsFix::fix_3d},         {"2", GpsFix::differential},
      {"3", GpsFix::fix_3d},         {"4", GpsFix::rtk_fixed},      {"5", GpsFix::rtk_float},
      {"6", GpsFix::dead_reckoning}, {"7", GpsFix::dead_reckoning}, {"8", GpsFix::dead_reckoning}};
  for (const auto& [quality, fix] : cases) {
    EXPECT_EQ(fixes(decode_text("nmea0183", gga("120000", quality)))[0].fix, fix) << quality;
  }
  EXPECT_EQ(decode_text("nmea0183", gga("120000", "x")).rejected.at(0).reason, RejectReason::field);
}

TEST(NmeaGps, AGgaWithoutItsStationIsOneAndKeepsItsDifferentialFix) {
  const std::string head = "GPGGA,120000,4807.038,N,01131.000,E,2,08,0.9,545.4,";
  const DecodeRun run =
      decode_text("nmea0183", sentence(head + "M,46.9,M,3.0") + rmc("120000", "010120", ",,"));
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(fixes(run)[0].fix, GpsFix::differential);
  EXPECT_DOUBLE_EQ(fixes(run)[0].altitude_msl_m, 545.4);
  // One field less without the units where they belong: something else is missing.
  for (const char* tail : {"M,46.9,,3.0", ",46.9,M,3.0", "M,46.9,M"}) {
    const DecodeRun cut = decode_text("nmea0183", sentence(head + tail));
    ASSERT_EQ(cut.rejected.size(), 1U) << tail;
    EXPECT_EQ(cut.rejected[0].reason, RejectReason::structure) << tail;
  }
}

TEST(NmeaGps, SentencesOfOneSecondAtTwoPlacesAreNotOneFix) {
  const auto rmc_at = [](const std::string& longitude) {
    return sentence("GPRMC,120000,A,4807.038,N," + longitude + ",W,010.0,090.0,010120,,,A");
  };
  const std::string gga_at = sentence("GPGGA,120000,4807.038,N,10200.000,W,1,08,0.9,545.4,M,46.9,M,,");
  const DecodeRun two = decode_text("nmea0183", gga_at + rmc_at("00200.000"));
  ASSERT_EQ(two.rejected.size(), 1U);
  EXPECT_EQ(two.rejected[0].reason, RejectReason::structure);
  ASSERT_EQ(two.samples.size(), 1U);
  EXPECT_NEAR(fixes(two)[0].longitude_rad, -102.0 * kRadPerDeg, 1e-9);
  EXPECT_TRUE(std::isnan(fixes(two)[0].velocity_N_m_s[0])) << "nothing of the other one";
  // What rounding leaves is one fix.
  const DecodeRun one = decode_text("nmea0183", gga_at + rmc_at("10200.04"));
  EXPECT_TRUE(one.rejected.empty());
  ASSERT_EQ(one.samples.size(), 1U);
  EXPECT_FALSE(std::isnan(fixes(one)[0].velocity_N_m_s[0]));
}

TEST(NmeaGps, GnsTakesTheBestConstellation) {
  const std::string gns = "GNGNS,103607.00,5327.03942,N,00214.42462,W,";
  EXPECT_EQ(fixes(decode_text("nmea0183", sentence(gns + "ANNN,06,5.88,56.0,48.5,,,V")))[0].fix,
            GpsFix::fix_3d);
  EXPECT_EQ(fixes(decode_text("nmea0183", sentence(gns + "AR,06,5.88,56.0,48.5,,")))[0].fix,
            GpsFix::rtk_fixed);
  EXPECT_EQ(fixes(decode_text("nmea0183", sentence(gns + "NNN,06,5.88,56.0,48.5,,")))[0].fix, GpsFix::none);
  const GpsSample sample = fixes(decode_text("nmea0183", sentence(gns + "AANN,06,5.88,56.0,48.5,,,V")))[0];
  EXPECT_NEAR(sample.altitude_m, 104.5, 1e-9);
  EXPECT_LT(sample.longitude_rad, 0.0);
}

TEST(NmeaGps, AnEmptyCourseAtRestLeavesTheVelocityUnknownUnlessItIsZero) {
  const std::string slow = sentence("GNRMC,003956.00,A,4552.65403,S,17030.00668,E,0.025,,120419,,,A,V");
  EXPECT_FALSE(known(fixes(decode_text("nmea0183", slow))[0].velocity_N_m_s[0]));
  const std::string still = sentence("GNRMC,003956.00,A,4552.65403,S,17030.00668,E,0.000,,120419,,,A,V");
  EXPECT_EQ(fixes(decode_text("nmea0183", still))[0].velocity_N_m_s[0], 0.0);
}

TEST(NmeaGps, BeforeADateOnlyTheTimeOfDay) {
  const DecodeRun run =
      decode_text("nmea0183", gga("000001") + gga("000002") + zda("000002", "19,02,2014") + gga("000003"));
  ASSERT_EQ(run.samples.size(), 3U);
  EXPECT_FALSE(run.samples[0].time.utc_ns.has_value());
  EXPECT_EQ(run.samples[0].time.time_of_day_ns, kNsPerSecond);
  EXPECT_EQ(run.samples[1].time.utc_ns, utc(2014, 2, 19, 0, 0, 2));
  EXPECT_EQ(run.samples[2].time.utc_ns, utc(2014, 2, 19, 0, 0, 3));
}

TEST(NmeaGps, TheCarriedDateCrossesMidnightInBothDirections) {
  const DecodeRun run = decode_text(
      "nmea0183", rmc("235958", "311219") + gga("235959") + gga("000000") + gga("000001") + gga("235959.5"));
  ASSERT_EQ(run.samples.size(), 5U);
  EXPECT_EQ(run.samples[1].time.utc_ns, utc(2019, 12, 31, 23, 59, 59));
  EXPECT_EQ(run.samples[2].time.utc_ns, utc(2020, 1, 1, 0, 0, 0));
  EXPECT_EQ(run.samples[3].time.utc_ns, utc(2020, 1, 1, 0, 0, 1));
  EXPECT_EQ(run.samples[4].time.utc_ns, utc(2019, 12, 31, 23, 59, 59) + kNsPerSecond / 2);
}

TEST(NmeaGps, TheDateOfTheNextEpochDoesNotDateTheOneBefore) {
  const DecodeRun run = decode_text("nmea0183", rmc("235957", "311219") + gga("235958") + gga("235959") +
                                                    rmc("000000", "010120") + gga("000000"));
  ASSERT_EQ(run.samples.size(), 4U);
  EXPECT_EQ(run.samples[2].time.utc_ns, utc(2019, 12, 31, 23, 59, 59));
  EXPECT_EQ(run.samples[3].time.utc_ns, utc(2020, 1, 1, 0, 0, 0));
}

TEST(NmeaGps, AZdaOfAnotherSecondDatesTheStreamAndMakesNoSample) {
  const DecodeRun run = decode_text("nmea0183", gga("193221") + zda("193223", "23,12,2007") + gga("193222"));
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(run.samples[1].time.utc_ns, utc(2007, 12, 23, 19, 32, 22));
}

TEST(NmeaGps, ZdaDatesASentenceWithoutTime) {
  const DecodeRun run = decode_text("nmea0183",
                                    "$GPGGA,,,,,,0,,,,M,,M,,*66\r\n$GPVTG,,T,,M,,N,,K,N*2C\r\n"
                                    "$GPZDA,193913.00,07,09,2018,00,00*63\r\n");
  ASSERT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.samples[0].time.utc_ns, utc(2018, 9, 7, 19, 39, 13));
}

TEST(NmeaGps, AWeekRolloverIsPassedOnAsTheReceiverSaysIt) {
  const DecodeRun run = decode_text("nmea0183", rmc("000030", "220899"));
  EXPECT_EQ(run.samples.at(0).time.utc_ns, utc(1999, 8, 22, 0, 0, 30));
}

TEST(NmeaGps, AMalformedDateWithAGoodChecksumIsRefused) {
  for (const char* date : {"2208-1", "22089", "2208990", "2208x9"}) {
    const DecodeRun run = decode_text("nmea0183", rmc("000030", date));
    ASSERT_EQ(run.rejected.size(), 1U) << date;
    EXPECT_EQ(run.rejected[0].reason, RejectReason::field) << date;
    EXPECT_TRUE(run.samples.empty()) << date;
  }
  for (const char* date : {"310299", "001299", "011399"}) {
    EXPECT_EQ(decode_text("nmea0183", rmc("000030", date)).rejected.at(0).reason, RejectReason::out_of_range);
  }
}

TEST(NmeaGps, TimeGoingBackIsAnotherEpoch) {
  const DecodeRun run = decode_text("nmea0183", rmc("120005", "010120") + rmc("120003", "010120"));
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_EQ(run.samples[1].time.utc_ns, utc(2020, 1, 1, 12, 0, 3));
}

TEST(NmeaGps, ARepeatedTimeIsAnotherEpochSoThatAFrozenReceiverIsSeen) {
  const std::string cycle = gga("120005") + rmc("120005", "010120");
  EXPECT_EQ(decode_text("nmea0183", cycle + cycle + cycle).samples.size(), 3U);
}

TEST(NmeaGps, TwoTalkersOfOneEpochMakeOneSample) {
  const std::string body = "GGA,120005,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,";
  const DecodeRun run = decode_text("nmea0183", sentence("GP" + body) + sentence("GL" + body));
  EXPECT_EQ(run.samples.size(), 1U);
}

TEST(NmeaGps, SentencesOfOneCycleWithDifferentTimesStayApart) {
  const DecodeRun run = decode_text(
      "nmea0183", rmc("230148", "261002") + gga("230149") + rmc("230150", "261002") + gga("230151"));
  ASSERT_EQ(run.samples.size(), 4U);
  EXPECT_FALSE(known(fixes(run)[0].altitude_m));
  EXPECT_FALSE(known(fixes(run)[1].velocity_N_m_s[0]));
}

TEST(NmeaGps, AnErrorEstimateAheadOfItsEpochWaitsForIt) {
  const DecodeRun run =
      decode_text("nmea0183", gst("120005") + gga("120005") + gst("120007") + gga("120006"));
  ASSERT_EQ(run.samples.size(), 2U);
  EXPECT_TRUE(known(fixes(run)[0].position_sigma_N_m[0]));
  EXPECT_FALSE(known(fixes(run)[1].position_sigma_N_m[0]));
}

TEST(NmeaGps, ImpossibleValuesAreRefused) {
  const auto reason = [](const std::string& body) {
    const DecodeRun run = decode_text("nmea0183", sentence(body));
    EXPECT_EQ(run.rejected.size(), 1U) << body;
    return run.rejected.at(0).reason;
  };
  EXPECT_EQ(reason("GPGGA,120000,9107.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,"),
            RejectReason::out_of_range);
  EXPECT_EQ(reason("GPGGA,120000,4807.038,N,18131.000,E,1,08,0.9,545.4,M,46.9,M,,"),
            RejectReason::out_of_range);
  EXPECT_EQ(reason("GPGGA,120000,4807.038,N,01131.000,E,1,08,0.9,nan,M,46.9,M,,"), RejectReason::field);
  EXPECT_EQ(reason("GPGGA,120000,4807.038,N,01131.000,E,1,08,0.9,1e9,M,46.9,M,,"), RejectReason::field);
  EXPECT_EQ(reason("GPGGA,120000,4807.038,N,01131.000,E,1,08,0.9,99999999,M,46.9,M,,"),
            RejectReason::out_of_range);
  EXPECT_EQ(reason("GPGGA,120000,4807.038,N,01131.000,E,1,08,0.9,545.4,F,46.9,M,,"), RejectReason::field);
  EXPECT_EQ(reason("GPRMC,120000,B,4807.038,N,01131.000,E,010.0,090.0,010120,,,A"), RejectReason::field);
  EXPECT_EQ(reason("GPRMC,120000,A,4807.038,N,01131.000,E,-10.0,090.0,010120,,,A"),
            RejectReason::out_of_range);
  EXPECT_EQ(reason("GPRMC,120000,A,4807.038,N,01131.000,E,010.0,390.0,010120,,,A"),
            RejectReason::out_of_range);
  EXPECT_EQ(reason("GPGGA,120000,4807.038,N"), RejectReason::structure);
  EXPECT_EQ(reason("GPVTG,090.0,010.0"), RejectReason::structure);
  EXPECT_EQ(reason("GPGST,120000,1,1"), RejectReason::structure);
  EXPECT_EQ(reason("GPZDA,120000,45,01,2020,00,00"), RejectReason::out_of_range);
}

TEST(NmeaGps, RangesToTheBottomAreAltitudesAndNoDepths) {
  const DecodeRun run =
      decode_text("nmea0183", "$SDDBT,7.9,f,2.4,M,1.3,F*0C\r\n" + sentence("SDDPT,2.4,0.5"));
  ASSERT_EQ(run.samples.size(), 2U);
  for (const auto& decoded : run.samples)
    EXPECT_TRUE(std::holds_alternative<AltimeterSample>(decoded.sample));
}

}  // namespace
}  // namespace fathom::codec

// Ranges of a WHOI Micro-Modem.

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "nmea_text.hpp"
#include "support/paths.hpp"

namespace fathom::codec {
namespace {

using test::decode_text;
using test::DecodeRun;
using test::sentence;

CodecOptions options() {
  CodecOptions out;
  out.beacons.sound_speed_m_s = 1480.0;
  out.beacons.list[0] = {"12", 0.6, 2.2, 30.0};
  out.beacons.list[1] = {"C", 0.7, 2.3, 40.0};
  out.beacons.count = 2;
  return out;
}

DecodeRun pinged(const std::string& text) {
  return decode_text("micromodem", text, options());
}

TEST(Micromodem, ThePingThatCameBackIsARangeToTheModemThatAnswered) {
  const DecodeRun ping = pinged(sentence("CAMPR,12,1,0.2500"));
  ASSERT_EQ(ping.samples.size(), 1U);
  const auto& sample = std::get<RangeSample>(ping.samples[0].sample);
  EXPECT_EQ(sample.beacon, Name("12"));
  EXPECT_DOUBLE_EQ(sample.range_m, 370.0);
  EXPECT_EQ(sample.travel_time_s, 0.25);
  EXPECT_EQ(sample.beacon_latitude_rad, 0.6);
  EXPECT_EQ(sample.beacon_longitude_rad, 2.2);
  EXPECT_EQ(sample.beacon_depth_m, 30.0);
  EXPECT_TRUE(std::isnan(sample.sigma_m));
  // The beacon answered one travel time before the sentence came.
  ASSERT_TRUE(ping.samples[0].time.age_ns);
  EXPECT_EQ(*ping.samples[0].time.age_ns, from_seconds(0.25));
}

TEST(Micromodem, ABeaconThatNobodyListedHasNoPlace) {
  const DecodeRun ping = pinged(sentence("CAMPR,7,1,1.0"));
  ASSERT_EQ(ping.samples.size(), 1U);
  const auto& sample = std::get<RangeSample>(ping.samples[0].sample);
  EXPECT_EQ(sample.beacon, Name("7"));
  EXPECT_DOUBLE_EQ(sample.range_m, 1480.0);
  EXPECT_TRUE(std::isnan(sample.beacon_latitude_rad));
}

TEST(Micromodem, EachTransponderThatAnsweredIsARange) {
  const DecodeRun four = pinged(sentence("SNTTA,0.1000,,0.3000,,120000.00"));
  ASSERT_EQ(four.samples.size(), 2U);
  const auto& a = std::get<RangeSample>(four.samples[0].sample);
  const auto& c = std::get<RangeSample>(four.samples[1].sample);
  EXPECT_EQ(a.beacon, Name("A"));
  EXPECT_DOUBLE_EQ(a.range_m, 148.0);
  EXPECT_FALSE(known(a.beacon_latitude_rad));
  EXPECT_EQ(c.beacon, Name("C"));
  EXPECT_DOUBLE_EQ(c.range_m, 444.0);
  EXPECT_EQ(c.beacon_latitude_rad, 0.7);
}

TEST(Micromodem, SilenceAndOtherWordsOfTheModemAreNoRange) {
  const DecodeRun other = pinged(sentence("SNTTA,,,,,120000.00") + sentence("CAMPR,12,1,") +
                                 sentence("CAREV,120000,AUV,0.93.0.30") + sentence("CAMPA,1,12"));
  EXPECT_TRUE(other.samples.empty());
  EXPECT_TRUE(other.rejected.empty());
  EXPECT_EQ(other.totals.frames_ignored, 4U);
}

TEST(Micromodem, WhatNoModemMeansIsRefused) {
  const auto reason = [](const std::string& text) {
    const DecodeRun one = pinged(text);
    EXPECT_TRUE(one.samples.empty()) << text;
    EXPECT_EQ(one.rejected.size(), 1U) << text;
    return one.rejected.empty() ? RejectReason::truncated : one.rejected[0].reason;
  };
  EXPECT_EQ(reason(sentence("CAMPR,12,1")), RejectReason::structure);
  EXPECT_EQ(reason(sentence("CAMPR,12,1,0.25,9")), RejectReason::structure);
  EXPECT_EQ(reason(sentence("CAMPR,12,1,zero")), RejectReason::field);
  EXPECT_EQ(reason(sentence("CAMPR,12,1,-0.25")), RejectReason::out_of_range);
  EXPECT_EQ(reason(sentence("CAMPR,12,1,21.0")), RejectReason::out_of_range);
  EXPECT_EQ(reason(sentence("CAMPR,128,1,0.25")), RejectReason::out_of_range);
  EXPECT_EQ(reason(sentence("CAMPR,,1,0.25")), RejectReason::incomplete);
  EXPECT_EQ(reason(sentence("SNTTA,0.1,0.2,0.3,120000.00")), RejectReason::structure);
  std::string damaged = sentence("CAMPR,12,1,0.2500");
  damaged[11] = '3';
  EXPECT_EQ(reason(damaged), RejectReason::checksum);
}

TEST(Micromodem, ALogOfItsLineGivesItsRanges) {
  std::ifstream in(test::vectors_dir() + "/micromodem/pings.txt", std::ios::binary);
  const DecodeRun log = pinged({std::istreambuf_iterator<char>(in), {}});
  std::vector<std::pair<std::string, double>> found;
  for (const RangeSample& one : log.all<RangeSample>())
    found.emplace_back(one.beacon.str(), one.travel_time_s);
  const std::vector<std::pair<std::string, double>> expected{{"12", 0.25}, {"A", 0.1},   {"C", 0.3},
                                                             {"7", 1.0},   {"12", 0.26}, {"A", 0.101},
                                                             {"B", 0.2},   {"C", 0.301}, {"D", 0.4}};
  EXPECT_EQ(found, expected);
  std::vector<RejectReason> refused;
  for (const Rejected& one : log.rejected) refused.push_back(one.reason);
  EXPECT_EQ(refused,
            (std::vector{RejectReason::checksum, RejectReason::out_of_range, RejectReason::truncated}));
}

}  // namespace
}  // namespace fathom::codec

// EvoLogics S2C modems with a USBL head.
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "support/codec/decode_run.hpp"
#include "support/paths.hpp"

namespace fathom::codec {
namespace {

using test::DecodeRun;

// What devices have sent: the clock of one since it was switched on, of the other in UTC.
const std::string kSinceStart =
    "USBLLONG,10446.991981,10446.534643,3,-0.0604,-1.0888,-0.5851,-0.4233,-1.0020,-0.5901,0.0063,0.0269,"
    "-0.3295,825,-36,77,1.2375";
const std::string kOfTheDay =
    "USBLLONG,1325384364.662679,1325384364.401149,2,0.0234,0.3407,-0.1417,-0.3286,0.0800,-0.1494,-0.0178,"
    "0.1164,1.3498,247,-16,388,0.0116";

std::string counted(const std::string& text) {
  return "+++AT:" + std::to_string(text.size()) + ":" + text + "\r\n";
}

DecodeRun heard(const std::string& text, const CodecOptions& options = {}) {
  return test::decode_whole("evologics", test::bytes_of(text), options);
}

CodecOptions on_vehicle() {
  CodecOptions options;
  options.usbl.carrier = UsblCarrier::vehicle;
  options.beacons.list[0] = {"3", 0.7, 0.2, 41.0};
  options.beacons.count = 1;
  return options;
}

UsblSample fix(const std::string& text, const CodecOptions& options = {}) {
  const DecodeRun run = heard(text, options);
  EXPECT_EQ(run.samples.size(), 1U) << text;
  EXPECT_TRUE(run.rejected.empty()) << text;
  return run.samples.empty() ? UsblSample{} : std::get<UsblSample>(run.samples[0].sample);
}

TEST(Evologics, OfAStationIsThePlaceOfTheVehicleAlongNorthEastDown) {
  const DecodeRun run = heard(counted(kSinceStart));
  ASSERT_EQ(run.samples.size(), 1U);
  const auto& sample = std::get<UsblSample>(run.samples[0].sample);
  EXPECT_EQ(sample.frame, UsblFrame::ned);
  EXPECT_EQ(sample.transponder.view(), "3");
  EXPECT_EQ(sample.relative_m, (std::array{-1.0020, -0.4233, 0.5901}));
  EXPECT_EQ(sample.sigma_m, 1.2375);
  EXPECT_DOUBLE_EQ(sample.travel_time_s, 825e-6);
  EXPECT_FALSE(known(sample.station_latitude_rad));
  ASSERT_TRUE(run.samples[0].time.age_ns);
  EXPECT_NEAR(to_seconds(*run.samples[0].time.age_ns), 0.457338, 1e-6);
  EXPECT_FALSE(run.samples[0].time.utc_ns);
}

TEST(Evologics, OnTheVehicleIsThePlaceOfABeaconAlongItsAxes) {
  const UsblSample sample = fix(counted(kSinceStart), on_vehicle());
  EXPECT_EQ(sample.frame, UsblFrame::vehicle_frd);
  EXPECT_EQ(sample.relative_m, (std::array{-0.0604, 1.0888, 0.5851}));
  EXPECT_EQ(sample.station_latitude_rad, 0.7);
  EXPECT_EQ(sample.station_longitude_rad, 0.2);
  EXPECT_EQ(sample.station_depth_m, 41.0);
  const UsblSample other = fix(counted(kOfTheDay), on_vehicle());
  EXPECT_EQ(other.transponder.view(), "2");
  EXPECT_FALSE(known(other.station_latitude_rad));
}

TEST(Evologics, ItsAxesAreForwardLeftUp) {
  // As the angles that it sends turn them into east, north, up.
  for (const std::string& line : {kSinceStart, kOfTheDay}) {
    const auto head = fix(counted(line), on_vehicle()).relative_m;
    const auto along_N = fix(counted(line)).relative_m;
    const bool first = line == kSinceStart;
    const std::array rpy = first ? std::array{0.0063, 0.0269, -0.3295} : std::array{-0.0178, 0.1164, 1.3498};
    const double x = head[0];
    const double y = -head[1] * std::cos(rpy[0]) + head[2] * std::sin(rpy[0]);
    const double z = -head[1] * std::sin(rpy[0]) - head[2] * std::cos(rpy[0]);
    const double level = x * std::cos(rpy[1]) + z * std::sin(rpy[1]);
    const double up = -x * std::sin(rpy[1]) + z * std::cos(rpy[1]);
    EXPECT_NEAR(level * std::cos(rpy[2]) - y * std::sin(rpy[2]), along_N[1], 5e-4) << line;
    EXPECT_NEAR(level * std::sin(rpy[2]) + y * std::cos(rpy[2]), along_N[0], 5e-4) << line;
    EXPECT_NEAR(up, -along_N[2], 5e-4) << line;
  }
}

TEST(Evologics, ALineThatIsNotCountedIsReadToItsEnd) {
  EXPECT_EQ(fix(kOfTheDay + "\n").relative_m, (std::array{0.0800, -0.3286, 0.1494}));
  const DecodeRun cut = heard(kOfTheDay);
  EXPECT_TRUE(cut.samples.empty());
  ASSERT_EQ(cut.rejected.size(), 1U);
  EXPECT_EQ(cut.rejected[0].reason, RejectReason::truncated);
}

TEST(Evologics, TheSigmaHasAFloor) {
  CodecOptions options;
  options.usbl.sigma_floor_m = 0.5;
  EXPECT_EQ(fix(counted(kOfTheDay), options).sigma_m, 0.5);
  EXPECT_EQ(fix(counted(kSinceStart), options).sigma_m, 1.2375);
  std::string unsaid = kSinceStart;
  unsaid.replace(unsaid.find("1.2375"), 6, "0.0000");
  EXPECT_FALSE(known(fix(counted(unsaid), options).sigma_m));
}

TEST(Evologics, OtherNotificationsAndPayloadCarryNoSample) {
  // A fix within a message that somebody sent is none of this head.
  const std::string payload = "RECVIM,132,3,1,ack,280000,-36,77,0.0,0.1," + kOfTheDay + "\r\n" + kSinceStart;
  const std::string angles =
      "USBLANGLES,10446.99,10446.53,3,0.1,0.2,0.3,0.4,0.0063,0.0269,-0.3295,-36,77,0.02";
  const DecodeRun run = heard("+++AT*SENDIM:2:OK\r\n" + counted("RECVSTART") + counted(payload) +
                              counted(angles) + angles + "\r\n");
  EXPECT_TRUE(run.samples.empty());
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.frames_ignored, 5U);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(Evologics, ALineThatLostBytesIsRefusedAndTheNextIsRead) {
  for (const std::size_t lost : {std::size_t{1}, std::size_t{40}, std::size_t{100}}) {
    std::string damaged = counted(kSinceStart);
    damaged.erase(20, lost);
    const DecodeRun run = heard(damaged + counted(kOfTheDay) + counted(kSinceStart));
    EXPECT_EQ(run.samples.size(), 2U) << lost;
    ASSERT_EQ(run.rejected.size(), 1U) << lost;
    EXPECT_EQ(run.rejected[0].reason, RejectReason::length) << lost;
  }
  // It breaks off where the next begins.
  const DecodeRun run = heard(counted(kSinceStart).substr(0, 60) + counted(kOfTheDay));
  EXPECT_EQ(run.samples.size(), 1U);
  EXPECT_EQ(run.rejected.size(), 1U);
}

RejectReason reason(const std::string& text) {
  const DecodeRun run = heard(text);
  EXPECT_TRUE(run.samples.empty()) << text;
  EXPECT_EQ(run.rejected.size(), 1U) << text;
  return run.rejected.empty() ? RejectReason::checksum : run.rejected[0].reason;
}

TEST(Evologics, WhatCannotBeIsRefused) {
  const auto with = [](const std::string& old, const std::string& now) {
    std::string text = kSinceStart;
    text.replace(text.find(old), old.size(), now);
    return counted(text);
  };
  EXPECT_EQ(reason(with(",1.2375", "")), RejectReason::structure);
  EXPECT_EQ(reason(with(",1.2375", ",1.2375,1")), RejectReason::structure);
  EXPECT_EQ(reason(with("-0.5851", "-O.5851")), RejectReason::field);
  EXPECT_EQ(reason(with("-0.5851", "")), RejectReason::field);
  EXPECT_EQ(reason(with(",3,", ",3.5,")), RejectReason::field);
  EXPECT_EQ(reason(with(",3,", ",255,")), RejectReason::out_of_range);
  EXPECT_EQ(reason(with("10446.991981", "10446.434643")),
            RejectReason::out_of_range);  // before it was measured
  EXPECT_EQ(reason(with("10446.991981", "11446.991981")), RejectReason::out_of_range);
  EXPECT_EQ(reason(with("-0.3295", "-18.879")), RejectReason::out_of_range);  // degrees
  EXPECT_EQ(reason(with(",825,", ",-1,")), RejectReason::out_of_range);
  EXPECT_EQ(reason(with(",1.2375", ",-0.1")), RejectReason::out_of_range);
  // The two places of one path are not equally far away.
  EXPECT_EQ(reason(with("-1.0020", "-1.1020")), RejectReason::structure);
  EXPECT_EQ(reason("+++AT:9999:" + kSinceStart + "\r\n"), RejectReason::length);
}

TEST(Evologics, ARecordedExchangeGivesItsFixes) {
  std::ifstream in(test::vectors_dir() + "/evologics/notifications.txt", std::ios::binary);
  const DecodeRun run = heard({std::istreambuf_iterator<char>(in), {}});
  EXPECT_TRUE(run.rejected.empty());
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
  EXPECT_EQ(run.totals.frames_ignored, 7U);
  std::vector<std::string> addresses;
  for (const UsblSample& one : run.all<UsblSample>()) addresses.push_back(one.transponder.str());
  EXPECT_EQ(addresses, (std::vector<std::string>{"3", "2"}));
}

}  // namespace
}  // namespace fathom::codec

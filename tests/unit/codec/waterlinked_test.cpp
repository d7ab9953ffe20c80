#include "codec/dvl/waterlinked.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "capture.hpp"

namespace fathom::codec {
namespace {

using capture::ByteVector;
using capture::Cut;
using capture::decode;
using capture::Harvest;
using capture::of_kind;

Harvest read(const std::string& stream) {
  return decode("waterlinked", ByteVector(stream.begin(), stream.end()));
}

const std::string kGood =
    R"({"time":100.5,"vx":1.5,"vy":-0.25,"vz":0.125,"fom":0.002,"covariance":[[1e-4,0,0],[0,4e-4,0],[0,0,1e-4]],)"
    R"("altitude":12.5,"transducers":[{"id":0,"velocity":0.1,"distance":13,"rssi":-40,"nsd":-95,"beam_valid":true},)"
    R"({"id":1,"velocity":0.2,"distance":13.5,"rssi":-40,"nsd":-95,"beam_valid":false}],"velocity_valid":true,)"
    R"("status":0,"format":"json_v3.1","type":"velocity","time_of_validity":1638191471563017,)"
    R"("time_of_transmission":1638191471752336})";

std::string with(std::string from, std::string to) {
  std::string line = kGood;
  const auto at = line.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return line.replace(at, from.size(), to);
}

TEST(WaterLinked, ReadsAReport) {
  const Harvest run = read(kGood + "\r\n");
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  const DvlSample& s = dvl[0].second;
  EXPECT_EQ(s.velocity_D_m_s, (std::array<double, 3>{1.5, -0.25, 0.125}));
  EXPECT_NEAR(s.sigma_m_s, std::sqrt(2e-4), 1e-15);
  EXPECT_EQ(s.altitude_m, 12.5);
  EXPECT_EQ(s.beam_velocity_m_s[0], 0.1);
  EXPECT_EQ(s.beam_range_m[0], 13.0);
  EXPECT_FALSE(known(s.beam_velocity_m_s[1]));
  EXPECT_FALSE(known(s.beam_velocity_m_s[3]));
  EXPECT_EQ(dvl[0].first.time.clock_ns, 1'638'191'471'563'017'000);
  EXPECT_EQ(dvl[0].first.time.age_ns, 189'319'000);
  EXPECT_EQ(run.totals.skipped_bytes, 0U);
}

TEST(WaterLinked, IsDeliveredWithItsClosingBrace) {
  const Harvest run = read(kGood);
  EXPECT_EQ(run.totals.samples, 1U);
}

TEST(WaterLinked, OnlyVelocityValidDecides) {
  const Harvest run = read(with(R"("velocity_valid":true)", R"("velocity_valid":false)"));
  const auto dvl = of_kind<DvlSample>(run);
  ASSERT_EQ(dvl.size(), 1U);
  EXPECT_FALSE(known(dvl[0].second.velocity_D_m_s[0]));
  EXPECT_FALSE(known(dvl[0].second.beam_velocity_m_s[0]));
  EXPECT_FALSE(known(dvl[0].second.sigma_m_s));
}

TEST(WaterLinked, AltitudeMinusOneIsUnknown) {
  const Harvest run = read(with(R"("altitude":12.5)", R"("altitude":-1)"));
  EXPECT_FALSE(known(of_kind<DvlSample>(run).at(0).second.altitude_m));
}

TEST(WaterLinked, WaterVelocity) {
  const Harvest run = read(with(R"("type":"velocity")", R"("type":"velocity_water")"));
  EXPECT_EQ(of_kind<DvlSample>(run).at(0).second.mode, DvlMode::water);
}

TEST(WaterLinked, OtherTypesAndKeysAreIgnored) {
  const Harvest run =
      read("{\"type\":\"position_local\",\"ts\":1}\n{\"type\":\"response\",\"success\":true}\n" +
           with(R"("status":0)", R"("status":0,"novelty":{"deep":[1,{"x":null}]})"));
  EXPECT_EQ(run.totals.frames_ignored, 2U);
  EXPECT_EQ(run.totals.samples, 1U);
}

struct WaterlinkedFault {
  const char* name;
  std::string stream;
  RejectReason reason;
};

class WaterLinkedFaults : public ::testing::TestWithParam<WaterlinkedFault> {};

TEST_P(WaterLinkedFaults, AreRefusedOnceAndTheNextReportIsFound) {
  const Harvest run = read(GetParam().stream + "\r\n" + kGood + "\r\n");
  ASSERT_EQ(run.rejected.size(), 1U);
  EXPECT_EQ(run.rejected[0].reason, GetParam().reason);
  EXPECT_EQ(run.rejected[0].offset, 0U);
  EXPECT_EQ(run.totals.samples, 1U);
}

INSTANTIATE_TEST_SUITE_P(
    All, WaterLinkedFaults,
    ::testing::Values(
        WaterlinkedFault{"cut", kGood.substr(0, 300), RejectReason::length},
        WaterlinkedFault{"cut_in_a_word", kGood.substr(0, 4), RejectReason::length},
        WaterlinkedFault{"not_json", R"({"type":velocity})", RejectReason::structure},
        WaterlinkedFault{"not_a_number", with(R"("vx":1.5)", R"("vx":NaN)"), RejectReason::structure},
        WaterlinkedFault{"beyond_double", with(R"("vx":1.5)", R"("vx":1e999)"), RejectReason::structure},
        WaterlinkedFault{"word_for_number", with(R"("vx":1.5)", R"("vx":"fast")"), RejectReason::field},
        WaterlinkedFault{"number_for_flag", with(R"("velocity_valid":true)", R"("velocity_valid":1)"),
                         RejectReason::field},
        WaterlinkedFault{"beam_nobody_has", with(R"("id":0)", R"("id":7)"), RejectReason::field},
        WaterlinkedFault{"impossible_speed", with(R"("vx":1.5)", R"("vx":1500)"), RejectReason::out_of_range},
        WaterlinkedFault{"no_type", R"({"vx":1})", RejectReason::structure},
        WaterlinkedFault{"too_deep", "{\"a\":[[[[[[[[[[1]]]]]]]]]]}", RejectReason::structure},
        WaterlinkedFault{"binary", std::string("{\"a\":\x01\x02}"), RejectReason::structure},
        WaterlinkedFault{"too_long", "{\"a\":\"" + std::string(9000, 'x') + "\"}", RejectReason::length}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(WaterLinked, EndlessGarbageIsSkippedInBoundedMemory) {
  const std::string garbage(1'000'000, '[');
  const Harvest run = read(garbage + kGood);
  EXPECT_EQ(run.totals.samples, 1U);
  EXPECT_EQ(run.totals.skipped_bytes, garbage.size());
}

}  // namespace
}  // namespace fathom::codec

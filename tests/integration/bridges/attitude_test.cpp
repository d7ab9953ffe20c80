// The heading bridge as a process of its own, with instruments that speak attitude sentences.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/units.hpp"
#include "samples/heading.hpp"
#include "sim/encode/nmea.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

TEST(HeadingBridge, ACompassAndAnInertialSystemSpeakAttitudeSentences) {
  constexpr int kDomain = 155;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<HeadingSample> headings(participant);
  const SerialDevice compass(folder / "compass");
  const SerialDevice inertial(folder / "inertial");
  const auto sensor = [&](const std::string& name, const std::string& more) {
    return R"({"name":")" + name + R"(","protocol":"nmea_attitude","rate_hz":5,"time":{"mode":"arrival"},)" +
           R"("source":{"type":"serial","path":")" + (folder / name) + R"(","backoff_most_s":0.2})" + more +
           "}";
  };
  const Process bridge("fathom-heading-bridge",
                       bridge_arguments("heading", kDomain,
                                        {"sensors=[" + sensor("compass", R"(,"north":"true")") + "," +
                                         sensor("inertial", "") + "]"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return headings.matched(); })) << bridge.output();
  const auto send = [](const SerialDevice& device, const std::string& text) {
    device.send(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  const auto count = [&](const char* name) {
    const auto all = headings.all();
    return std::count_if(all.begin(), all.end(),
                         [&](const HeadingSample& one) { return one.header.sensor == Name(name); });
  };
  ASSERT_TRUE(eventually([&] {
    send(compass, "$C320.5P0.2R-18.3T19.0*3C\r\n");
    send(inertial, "$PASHR,183944.821,74.52,T,-1.63,1.51,0.14,0.020,0.020,0.012,2,1*05\r\n" +
                       sim::encode::nmea_sentence("HEHDT,74.52,T"));
    return count("compass") > 3 && count("inertial") > 3;
  })) << bridge.output();
  for (const HeadingSample& sample : headings.all()) {
    const bool is_compass = sample.header.sensor == Name("compass");
    EXPECT_EQ(sample.north, North::true_north);
    EXPECT_NEAR(sample.heading_rad, (is_compass ? 320.5 : 74.52) * kRadPerDeg, 1e-12);
    EXPECT_EQ(known(sample.sigma_rad), !is_compass);
  }
}

}  // namespace
}  // namespace fathom::test

// The altimeter's bridge as a process of its own.

#include "samples/altimeter.hpp"

#include <gtest/gtest.h>

#include "samples/depth.hpp"
#include "sim/encode/altimeter.hpp"
#include "sim/encode/nmea.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

TEST(AltimeterBridge, DptAndDbtBecomeAltitudesAndNonsenseIsRefused) {
  constexpr int kDomain = 152;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<AltimeterSample> altimeter(participant);
  const SerialDevice device(folder / "altimeter");
  const Process bridge(
      "fathom-altimeter-bridge",
      bridge_arguments("altimeter", kDomain,
                       {R"(sensors.0.source={"type":"serial","path":")" + (folder / "altimeter") +
                            R"(","backoff_most_s":0.2,"silence_s":1})",
                        "sensors.0.max_altitude_m=100"}),
      folder / "log");
  ASSERT_TRUE(eventually([&] { return altimeter.matched(); })) << bridge.output();
  AltimeterSample sent;
  sent.altitude_m = 12.34;
  sent.transducer_offset_m = 0.5;
  AltimeterSample too_far = sent;
  too_far.altitude_m = 150.0;  // beyond max_altitude_m
  const auto bytes_of = [](const std::string& text) {
    return std::vector<std::uint8_t>(text.begin(), text.end());
  };
  const auto bytes = bytes_of(sim::encode::nmea_dpt(too_far) + "$INDPT,2.3,0.0*47\r\n" +  // a wrong checksum
                              sim::encode::nmea_dpt(sent) + "$SDDBT,8.1,f,2.4,M,1.3,F*0B\r\n");
  ASSERT_TRUE(eventually([&] {
    device.send(bytes);
    return altimeter.count() > 7;
  })) << bridge.output();
  int dpt = 0;
  int dbt = 0;
  const auto all = altimeter.all();  // more may still come
  for (const AltimeterSample& sample : all) {
    EXPECT_EQ(sample.header.sensor, Name("altimeter"));
    if (sample.altitude_m == 12.34 && sample.transducer_offset_m == 0.5) ++dpt;
    if (sample.altitude_m == 2.4 && !known(sample.transducer_offset_m)) ++dbt;
  }
  EXPECT_GT(dpt, 0);
  EXPECT_GT(dbt, 0);
  EXPECT_EQ(static_cast<std::size_t>(dpt + dbt), all.size());
}

// A Ping1D tells nothing before it is asked, and forgets that it was when its supply fails.
TEST(AltimeterBridge, AsksAnEchoSounderThatIsSilentUntilItIsAsked) {
  constexpr int kDomain = 156;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<AltimeterSample> altimeter(participant);
  const SerialDevice device(folder / "ping");
  const Process bridge("fathom-altimeter-bridge",
                       bridge_arguments("altimeter", kDomain,
                                        {"sensors.0.protocol=ping",
                                         R"(sensors.0.source={"type":"serial","path":")" + (folder / "ping") +
                                             R"(","backoff_most_s":0.2,"silence_s":0.4})"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return altimeter.matched(); })) << bridge.output();
  const std::string request{"BR\x02\x00\x78\x05\x00\x00\x14\x05\x2C\x01", 12};
  const auto is_asked = [&] { return device.heard().find(request) != std::string::npos; };
  AltimeterSample bottom;
  bottom.altitude_m = 7.515;
  std::uint32_t number = 0;
  for (int supply = 0; supply < 2; ++supply) {
    ASSERT_TRUE(eventually(is_asked)) << bridge.output();
    const std::size_t before = altimeter.count();
    ASSERT_TRUE(eventually([&] {
      device.send(sim::encode::ping_profile(bottom, ++number));
      return altimeter.count() > before + 3;
    })) << bridge.output();
    (void)device.heard();
  }
  for (const AltimeterSample& sample : altimeter.all()) EXPECT_NEAR(sample.altitude_m, 7.515, 1e-12);
}

// One line, two bridges.
TEST(AltimeterBridge, ASentenceWithRangeAndPressureIsADepthAsWell) {
  constexpr int kDomain = 157;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<AltimeterSample> altimeter(participant);
  const Collector<DepthSample> depth(participant);
  const SerialDevice device(folder / "va500");
  const auto sensor = [&](const std::string& name, const std::string& more) {
    return R"(sensors=[{"name":")" + name +
           R"(","protocol":"nmea0183","rate_hz":4,"time":{"mode":"arrival"},)" +
           R"("source":{"type":"serial","path":")" + (folder / "va500") +
           R"(","shared":true,"backoff_most_s":0.2})" + more + "}]";
  };
  const Process altimeter_bridge("fathom-altimeter-bridge",
                                 bridge_arguments("altimeter", kDomain, {sensor("altimeter", "")}),
                                 folder / "log1");
  const Process depth_bridge("fathom-depth-bridge",
                             bridge_arguments("depth", kDomain, {sensor("depth", R"(,"latitude_deg":30)")}),
                             folder / "log2");
  ASSERT_TRUE(eventually([&] {
    const std::string text = sim::encode::nmea_sentence("PRVAT,12.345,M,1010.132,dBar");
    device.send(std::vector<std::uint8_t>(text.begin(), text.end()));
    return altimeter.count() > 2 && depth.count() > 2;
  })) << altimeter_bridge.output()
      << depth_bridge.output();
  EXPECT_EQ(altimeter.all().back().altitude_m, 12.345);
  EXPECT_NEAR(depth.all().back().depth_m, 990.81, 0.02);
}

}  // namespace
}  // namespace fathom::test

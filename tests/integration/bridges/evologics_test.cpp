// The bridge of a USBL head on the vehicle as a process of its own.

#include "sim/encode/evologics.hpp"

#include <gtest/gtest.h>

#include "samples/usbl.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

TEST(UsblBridge, AHeadOnTheVehicleGivesPlacesOfBeaconsAsOldAsItsLinesSay) {
  constexpr int kDomain = 154;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<UsblSample> fixes(participant);
  const SerialDevice device(folder / "head");
  const Process bridge(
      "fathom-usbl-bridge",
      bridge_arguments(
          "usbl", kDomain,
          {R"(sensors.0={"name":"head","protocol":"evologics","rate_hz":0.5,"time":{"mode":"arrival"},)"
           R"("source":{"type":"serial","path":")" +
           (folder / "head") +
           R"(","backoff_most_s":0.2,"silence_s":1},"carried_by":"vehicle",)"
           R"("max_range_m":500,"beacons":[{"address":"7","latitude_deg":36.4,)"
           R"("longitude_deg":127.4,"depth_m":20}]})"}),
      folder / "log");
  ASSERT_TRUE(eventually([&] { return fixes.matched(); })) << bridge.output();
  const auto line = [](const char* beacon, double forward_m) {
    UsblSample sent;
    sent.frame = UsblFrame::vehicle_frd;
    sent.transponder = beacon;
    sent.relative_m = {forward_m, -20.0, 5.0};
    sent.sigma_m = 0.8;
    return sim::encode::evologics(sent, 100 * kNsPerSecond, 100 * kNsPerSecond + 400 * kNsPerMillisecond);
  };
  const std::string text = line("7", 600.0) + line("7", 30.0) + line("9", 40.0);
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  ASSERT_TRUE(eventually([&] {
    device.send(bytes);
    return fixes.count() > 7;
  })) << bridge.output();
  int placed = 0;
  int elsewhere = 0;
  const auto heard = fixes.all();  // more may be on their way
  for (const UsblSample& sample : heard) {
    EXPECT_EQ(sample.header.sensor, Name("head"));
    EXPECT_EQ(sample.frame, UsblFrame::vehicle_frd);
    EXPECT_EQ(sample.relative_m[1], -20.0);
    EXPECT_EQ(sample.header.received_ns - sample.header.stamp_ns, 400 * kNsPerMillisecond);
    if (sample.transponder == Name("7") && sample.relative_m[0] == 30.0 && sample.station_depth_m == 20.0)
      ++placed;
    if (sample.transponder == Name("9") && !known(sample.station_depth_m)) ++elsewhere;
  }
  EXPECT_GT(placed, 0);
  EXPECT_GT(elsewhere, 0);
  EXPECT_EQ(static_cast<std::size_t>(placed + elsewhere), heard.size());
}

}  // namespace
}  // namespace fathom::test

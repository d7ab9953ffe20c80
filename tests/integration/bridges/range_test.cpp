// The bridge of an acoustic modem as a process of its own.

#include "samples/range.hpp"

#include <gtest/gtest.h>

#include "sim/encode/micromodem.hpp"
#include "support.hpp"

namespace fathom::test {
namespace {

TEST(RangeBridge, TravelTimesBecomeRangesToPlacesAndTooFarIsRefused) {
  constexpr int kDomain = 153;
  const TemporaryFolder folder;
  bus::Participant participant(test_participant(kDomain));
  const Collector<RangeSample> ranges(participant);
  const SerialDevice device(folder / "modem");
  const Process bridge("fathom-range-bridge",
                       bridge_arguments("range", kDomain,
                                        {R"(sensors.0.source={"type":"serial","path":")" +
                                             (folder / "modem") + R"(","backoff_most_s":0.2,"silence_s":1})",
                                         "sensors.0.max_range_m=1000", "sensors.0.sound_speed_m_s=1480"}),
                       folder / "log");
  ASSERT_TRUE(eventually([&] { return ranges.matched(); })) << bridge.output();
  const auto answer = [](const char* beacon, double travel_time_s) {
    RangeSample sent;
    sent.beacon = beacon;
    sent.travel_time_s = travel_time_s;
    return sim::encode::micromodem(sent);
  };
  const std::string text = answer("12", 0.9) + answer("12", 0.25) + answer("77", 0.5);
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  ASSERT_TRUE(eventually([&] {
    device.send(bytes);
    return ranges.count() > 7;
  })) << bridge.output();
  int placed = 0;
  int elsewhere = 0;
  const auto heard = ranges.all();  // more may be on their way
  for (const RangeSample& sample : heard) {
    EXPECT_EQ(sample.header.sensor, Name("modem"));
    EXPECT_LT(sample.range_m, 1000.0);
    if (sample.beacon == Name("12") && sample.range_m == 370.0 && sample.beacon_depth_m == 20.0) ++placed;
    if (sample.beacon == Name("77") && sample.range_m == 740.0 && !known(sample.beacon_depth_m)) ++elsewhere;
  }
  EXPECT_GT(placed, 0);
  EXPECT_GT(elsewhere, 0);
  EXPECT_EQ(static_cast<std::size_t>(placed + elsewhere), heard.size());
}

}  // namespace
}  // namespace fathom::test

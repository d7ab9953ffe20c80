// Positions and orders that ROS 2 tells, between a peer of ROS 2 and fathom's bus.

#include <mutex>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "geo/wgs84.hpp"
#include "integration/ros2/gateway.hpp"
#include "samples/command.hpp"
#include "samples/position/fix.hpp"

namespace fathom {
namespace {

using namespace test;  // NOLINT(google-build-using-namespace): the gateway and the vehicle
using ::testing::HasSubstr;

/// The last sample of a topic.
template <class Sample>
class Last {
 public:
  explicit Last(bus::Participant& participant)
      : reader_(participant, [this](const Sample& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          last_ = sample;
        }) {}
  std::optional<Sample> get() {
    const std::lock_guard lock(mutex_);
    return last_;
  }

 private:
  std::mutex mutex_;
  std::optional<Sample> last_;
  bus::Reader<Sample> reader_;
};

class Told : public Ros2Gateway {
 protected:
  /// The gateway's answer to an order.
  nlohmann::json answer(const std::string& order) {
    Peer asks("write", kGraph, {"string", "rt/fathom/order", order});
    Peer hears("read", kGraph, {"string", "rt/fathom/order/answer"});
    const std::string text = hears.output();
    const std::size_t at = text.find('{');
    return at == std::string::npos ? nlohmann::json(text)
                                   : nlohmann::json::parse(text.substr(at), nullptr, false);
  }
};

TEST_F(Told, APoseInMapIsAFix) {
  start({"frames.origin_lat_deg=36.4", "frames.origin_lon_deg=-121.5", "frames.origin_altitude_m=-3",
         R"(inputs=[{"kind":"pose","topic":"/usbl/pose","sensor":"ship","frame_id":"map","oldest_s":600}])"});
  Last<FixSample> fix(vehicle.participant());
  const Peer peer("write", kGraph, {"pose", "rt/usbl/pose"});
  ASSERT_TRUE(wait_until([&] { return fix.get().has_value(); }, 20.0)) << gateway->err();
  const FixSample heard = *fix.get();
  EXPECT_EQ(heard.header.sensor, Name("ship"));
  EXPECT_LT(std::abs(to_seconds(SystemClock().utc_ns() - heard.header.stamp_ns)), 5.0);
  const Eigen::Vector3d from_N =
      geo::difference_N(kOrigin, {heard.latitude_rad, heard.longitude_rad, kOrigin.altitude_m});
  EXPECT_NEAR(from_N.x(), 400.0, 1e-3) << "y of map is north";
  EXPECT_NEAR(from_N.y(), 300.0, 1e-3) << "x of map is east";
  EXPECT_EQ(heard.sigma_m, 10.0) << "the greater of both";
  EXPECT_TRUE(std::isnan(heard.depth_m));
}

TEST_F(Told, OrdersBecomeCommands) {
  start({"orders.topic=order"});
  Last<Command> command(vehicle.participant());
  const auto sent = answer(R"({"kind": "disable_source", "target": "gps"})");
  EXPECT_EQ(sent,
            nlohmann::json({{"accepted", true}, {"confirm", false}, {"text", "Sent: disable_source gps."}}))
      << gateway->err();
  ASSERT_TRUE(wait_until([&] { return command.get().has_value(); }));
  EXPECT_EQ(command.get()->kind, CommandKind::disable_source);
  EXPECT_EQ(command.get()->target, Name("gps"));
  EXPECT_EQ(command.get()->header.sensor, Name("ros2"));
  EXPECT_EQ(command.get()->header.vehicle, Name("auv"));
}

TEST_F(Told, APositionThatIsFarAwayWaitsToBeConfirmed) {
  start({"orders.topic=order"});
  Last<Command> command(vehicle.participant());
  // What is far away is known once the gateway has heard where navigation is.
  const Peer tf("follow", kGraph, {"tf", "rt/tf"});
  ASSERT_TRUE(wait_until([&] { return lines_of(tf.so_far()).size() > 100; }, 20.0));
  const std::string place =
      R"("kind": "set_position", "lat_deg": 37, "lon_deg": -121.5, "depth_m": 3, "sigma_m": 10)";
  const auto held = answer("{" + place + "}");
  EXPECT_EQ(held.value("accepted", false), true);
  EXPECT_EQ(held.value("confirm", false), true);
  EXPECT_THAT(held.value("text", ""), HasSubstr("until it is confirmed"));
  const auto meant = answer("{" + place + R"(, "confirmed": true})");
  EXPECT_EQ(meant.value("confirm", true), false) << meant;
  ASSERT_TRUE(wait_until([&] { return command.get() && command.get()->confirmed; }));
}

TEST_F(Told, APositionByTextIsAFixAndWhatIsNoOrderIsRefused) {
  start({"orders.topic=order"});
  Last<FixSample> fix(vehicle.participant());
  Last<Command> command(vehicle.participant());
  const auto told = answer(
      R"({"kind": "fix", "lat_deg": 36.5, "lon_deg": -121.5, "sigma_m": 20, "age_s": 600, "from": "ship"})");
  EXPECT_EQ(told.value("accepted", false), true);
  ASSERT_TRUE(wait_until([&] { return fix.get().has_value(); }));
  EXPECT_NEAR(to_seconds(fix.get()->header.received_ns - fix.get()->header.stamp_ns), 600.0, 1e-6);
  EXPECT_EQ(fix.get()->header.sensor, Name("ship"));
  const auto refused = answer(R"({"kind": "self_destruct"})");
  EXPECT_EQ(refused.value("accepted", true), false);
  EXPECT_THAT(refused.value("text", ""), HasSubstr("Expected JSON with a kind: set_position"));
  EXPECT_FALSE(command.get());
  EXPECT_TRUE(gateway->says("refused an order of ROS 2")) << gateway->err();
}

TEST_F(Told, NoOrdersAreTakenUnlessATopicIsNamed) {
  start();
  Last<Command> command(vehicle.participant());
  const Peer asks("write", kGraph, {"string", "rt/fathom/order", R"({"kind": "realign"})"});
  const Peer tf("follow", kGraph, {"tf", "rt/tf"});  // by the time it is heard, an order would be as well
  ASSERT_TRUE(wait_until([&] { return lines_of(tf.so_far()).size() > 100; }, 20.0));
  EXPECT_FALSE(command.get());
}

}  // namespace
}  // namespace fathom

// What the file of the gateway to ROS 2 may say, and what it is told when it may not.

#include "config/doors/ros2_gateway_config.hpp"

#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "config/service_config.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// What is said of the shipped file, changed; empty where it can be used.
template <class Change>
std::string complaint(Change change) {
  std::ifstream in(test::source_dir() + "/deploy/config/ros2_gateway.json");
  json file = json::parse(in);
  change(file);
  const std::string path =
      ::testing::TempDir() + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
  std::ofstream(path) << file.dump(2);
  try {
    (void)load_service_config<Ros2GatewayConfig>({path, {}});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

json frame(const char* parent, const char* child) {
  return {{"parent", parent}, {"child", child}};
}
json input(const char* kind, const char* topic, const char* sensor) {
  return {{"kind", kind}, {"topic", topic}, {"sensor", sensor}, {"frame_id", ""}, {"rate_hz", 10}};
}

TEST(Ros2GatewayConfig, TakesTheShippedFile) {
  EXPECT_EQ(complaint([](json&) {}), "");
}

TEST(Ros2GatewayConfig, HasATreeOfFrames) {
  const auto with = [](std::vector<json> frames) {
    return complaint([&](json& file) { file["frames"]["static"] = frames; });
  };
  EXPECT_EQ(with({frame("base_link", "dvl_link"), frame("dvl_link", "beam_link"), frame("earth", "world")}),
            "");
  EXPECT_THAT(with({frame("base_link", "odom")}), HasSubstr("static.0.child"));
  EXPECT_THAT(with({frame("earth", "map")}), HasSubstr("static.0.child"));
  EXPECT_THAT(with({frame("base_link", "a"), frame("odom", "a")}), HasSubstr("static.1.child"));
  EXPECT_THAT(with({frame("a", "b"), frame("b", "a")}), HasSubstr("its own ancestor"));
  EXPECT_THAT(with({frame("a", "a")}), HasSubstr("its own ancestor"));
  EXPECT_THAT(with({frame("base_link", "/dvl")}), HasSubstr("without a slash"));
  EXPECT_THAT(complaint([](json& file) { file["frames"]["odom"] = "map"; }),
              HasSubstr("three different names"));
}

TEST(Ros2GatewayConfig, KnowsAllOfTheOriginOrNothing) {
  EXPECT_THAT(complaint([](json& file) { file["frames"]["origin_lat_deg"] = 36.0; }),
              HasSubstr("or none of them"));
  EXPECT_EQ(complaint([](json& file) {
              file["frames"]["origin_lat_deg"] = 36.0;
              file["frames"]["origin_lon_deg"] = -121.0;
              file["frames"]["origin_altitude_m"] = 0.0;
            }),
            "");
}

TEST(Ros2GatewayConfig, NamesTopicsAsRosDoes) {
  const auto with = [](const char* topic) {
    return complaint([&](json& file) { file["outputs"]["pose"]["topic"] = topic; });
  };
  for (const char* good : {"a", "/a", "a/b_2", "/_x/y", ""}) EXPECT_EQ(with(good), "") << good;
  for (const char* bad : {"2a", "a//b", "a/", "/", "a b", "a-b", "a/2b"}) {
    EXPECT_THAT(with(bad), HasSubstr("outputs.pose.topic")) << bad;
  }
  EXPECT_THAT(with("odometry"), HasSubstr("a topic of its own"));
  EXPECT_THAT(complaint([](json& file) { file["ros"]["namespace"] = "fathom"; }), HasSubstr("ros.namespace"));
  EXPECT_THAT(complaint([](json& file) { file["ros"]["node"] = "a/b"; }), HasSubstr("ros.node"));
  EXPECT_EQ(ros_topic("/", "imu"), "/imu");
  EXPECT_EQ(ros_topic("/auv", "imu"), "/auv/imu");
  EXPECT_EQ(ros_topic("/auv", "/tf"), "/tf");
}

TEST(Ros2GatewayConfig, TakesEachTopicAndEachInstrumentOnce) {
  const auto with = [](std::vector<json> inputs) {
    return complaint([&](json& file) { file["inputs"] = inputs; });
  };
  EXPECT_EQ(with({input("imu", "/a", "one"), input("imu", "/b", "two"), input("dvl", "/c", "one")}), "");
  EXPECT_THAT(with({input("imu", "/a", "one"), input("imu", "/a", "two")}), HasSubstr("inputs.1.topic"));
  EXPECT_THAT(with({input("imu", "/a", "one"), input("imu", "/b", "one")}), HasSubstr("inputs.1.sensor"));
  EXPECT_THAT(with({input("dvl", "/a", "one"), input("twist", "/b", "one")}), HasSubstr("inputs.1.sensor"));
  EXPECT_THAT(with({input("imu", "odometry", "one")}), HasSubstr("inputs.0.topic")) << "what it says itself";
  EXPECT_THAT(with({input("fluid_pressure", "/a", "one")}), HasSubstr("lat_deg"));
  json other = input("imu", "/a", "one");
  other["lat_deg"] = 36.0;
  EXPECT_THAT(with({other}), HasSubstr("lat_deg")) << "means nothing for an imu";
}

TEST(Ros2GatewayConfig, LeavesAProtectedNetworkAlone) {
  const auto with = [](int domain) {
    return complaint([&](json& file) {
      file["bus"]["security"]["folder"] = "/etc/fathom/security";
      file["ros"]["domain"] = domain;
    });
  };
  EXPECT_THAT(with(0), HasSubstr("ros.domain"));
  EXPECT_EQ(with(1), "");
}

TEST(Ros2GatewayConfig, TakesPosesOnlyInAMapThatHasAPlace) {
  const auto with = [](const char* frame_id, bool origin) {
    return complaint([&](json& file) {
      file["inputs"] = {{{"kind", "pose"}, {"topic", "/pose"}, {"sensor", "ship"}, {"frame_id", frame_id}}};
      if (!origin) return;
      for (const char* key : {"origin_lat_deg", "origin_lon_deg", "origin_altitude_m"})
        file["frames"][key] = 1.0;
    });
  };
  EXPECT_EQ(with("map", true), "");
  EXPECT_THAT(with("map", false), HasSubstr("frames.origin_lat_deg"));
  EXPECT_THAT(with("odom", true), HasSubstr("inputs.0.frame_id"));
  EXPECT_THAT(with("", true), HasSubstr("inputs.0.frame_id"));
  EXPECT_THAT(complaint([](json& file) { file["inputs"] = {input("pose", "/pose", "ship")}; }),
              HasSubstr("rate_hz"))
      << "a position that is told has no rate";
}

TEST(Ros2GatewayConfig, TakesNoOrdersOntoAProtectedNetwork) {
  const auto with = [](const char* topic, bool is_protected) {
    return complaint([&](json& file) {
      file["orders"]["topic"] = topic;
      if (!is_protected) return;
      file["bus"]["security"] = {{"folder", "/etc/fathom/security"}, {"identity", ""}};
      file["ros"]["domain"] = 42;
    });
  };
  EXPECT_EQ(with("order", false), "");
  EXPECT_EQ(with("", true), "");
  EXPECT_THAT(with("order", true), HasSubstr("orders.topic"));
  EXPECT_THAT(with("an order", false), HasSubstr("orders.topic"));
  EXPECT_THAT(with("odometry", false), HasSubstr("orders.topic"));
}

}  // namespace
}  // namespace fathom::config

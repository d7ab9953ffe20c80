// Documents put together from several remember where each value came from.
#include "config/json/layers.hpp"

#include <gtest/gtest.h>

namespace fathom::config {
namespace {

using nlohmann::json;

const Origin kVehicle{Layer::vehicle, "vehicle.json", "instruments.0"};
const Origin kOwn{Layer::override_, "gps_bridge.json", ""};

TEST(Layers, NobodySaidWhatIsNotThere) {
  const Layers layers;
  EXPECT_EQ(layers.origin_of("a.b").layer, Layer::standard);
  EXPECT_TRUE(layers.value().empty());
}

TEST(Layers, ObjectsAreMergedKeyByKey) {
  Layers layers;
  layers.overlay("", {{"a", {{"x", 1}, {"y", 2}}}}, kVehicle);
  layers.overlay("", {{"a", {{"y", 3}}}}, kOwn);
  EXPECT_EQ(layers.value(), json({{"a", {{"x", 1}, {"y", 3}}}}));
  EXPECT_EQ(layers.origin_of("a.x").layer, Layer::vehicle);
  EXPECT_EQ(layers.origin_of("a.x").key, "instruments.0.a.x");
  EXPECT_EQ(layers.origin_of("a.y").layer, Layer::override_);
  EXPECT_EQ(layers.origin_of("a.y").key, "a.y");
}

TEST(Layers, NamedElementsAreMergedByName) {
  Layers layers;
  layers.overlay("", json::parse(R"({"sensors": [{"name": "a", "v": 1}, {"name": "b", "v": 2}]})"), kVehicle);
  layers.overlay("", json::parse(R"({"sensors": [{"name": "b", "v": 3}, {"name": "c", "v": 4}]})"), kOwn);
  EXPECT_EQ(layers.value(), json::parse(R"({"sensors": [{"name": "a", "v": 1}, {"name": "b", "v": 3},
                                                        {"name": "c", "v": 4}]})"));
  EXPECT_EQ(layers.origin_of("sensors.1.v").key, "sensors.0.v") << "where it stands in its own file";
  EXPECT_EQ(layers.origin_of("sensors.0.v").layer, Layer::vehicle);
}

TEST(Layers, OtherListsAreReplacedAndForgotten) {
  Layers layers;
  layers.overlay("", {{"sigma", {1, 2, 3}}}, kVehicle);
  layers.overlay("", {{"sigma", {4}}}, kOwn);
  EXPECT_EQ(layers.value().at("sigma"), json({4}));
  EXPECT_EQ(layers.origin_of("sigma").layer, Layer::override_);
  EXPECT_EQ(layers.origin_of("sigma").key, "sigma");
  EXPECT_EQ(layers.origin_of("sigma.2").layer, Layer::standard);
}

TEST(Layers, NeighboursWithTheSameBeginningStay) {
  Layers layers;
  layers.overlay("", {{"a", {{"x", 1}}}, {"a_b", 2}, {"a-b", 3}, {"a0", 4}}, kVehicle);
  layers.overlay("", {{"a", 5}}, kOwn);
  for (const char* key : {"a_b", "a-b", "a0"}) EXPECT_EQ(layers.origin_of(key).layer, Layer::vehicle) << key;
  EXPECT_EQ(layers.origin_of("a").layer, Layer::override_);
  EXPECT_EQ(layers.origin_of("a.x").layer, Layer::standard);
}

TEST(Layers, ComplaintsAreAboutTheFileThatSaidIt) {
  Layers layers("vehicle.json");
  layers.overlay("sensors", json::array(), {});
  layers.grow("sensors");
  layers.mark("sensors.0", kVehicle.child("bridge"));
  layers.overlay("sensors.0.rate_hz", -1, kVehicle.child("rate_hz"));
  const auto text_of = [&](const std::string& key) -> std::string {
    try {
      layers.fail(ConfigError("vehicle.json", key, "-1", "more"));
    } catch (const ConfigError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(text_of("sensors.0.rate_hz"), "vehicle.json: instruments.0.rate_hz: is -1, expected more");
  EXPECT_EQ(text_of("sensors.0.unit"), "vehicle.json: instruments.0.bridge.unit: is -1, expected more");
}

TEST(Layers, AComplaintAboutAnotherFileStays) {
  Layers layers("vehicle.json");
  layers.overlay("", {{"mass", 1}}, kVehicle);
  try {
    layers.fail(ConfigError("hydro.json", "mass", "1", "2"));
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.file(), "hydro.json");
    EXPECT_EQ(error.key(), "mass");
  }
}

}  // namespace
}  // namespace fathom::config

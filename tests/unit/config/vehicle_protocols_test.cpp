// What registry and catalogue say of an instrument: how a vehicle's bridge stamps and turns its samples, and
// how far fusion trusts it.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "codec/registry.hpp"
#include "config/bridge/bridge_config.hpp"
#include "config/fusion/fusion_config.hpp"
#include "config/service_config.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;

class ProtocolOfAVehicle : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("FATHOM_CATALOGUE_DIR", (test::source_dir() + "/deploy/config/catalogue").c_str(), 1);
  }
  void TearDown() override { std::filesystem::remove(path_); }

  /// The one inertial unit of a vehicle, as its bridge has it.
  ImuSensorConfig bridge_of(const json& more) {
    json unit = {{"name", "imu"},           {"kind", "imu"},
                 {"rate_hz", 100},          {"port", {{"type", "serial"}, {"path", "/dev/ttyUSB0"}}},
                 {"position_m", {0, 0, 0}}, {"mounting_rpy_deg", {0, 0, 0}}};
    unit.update(more);
    write(json::array({unit}));
    return load_service_config<ImuBridgeConfig>(with_vehicle({}, path_, "imu_bridge")).value.sensors.at(0);
  }
  /// A receiver on the line of that unit, as its bridge has it.
  SensorConfig receiver_of(std::string_view protocol) {
    const json port = {{"type", "serial"}, {"path", "/dev/ttyUSB0"}, {"shared", true}};
    write({{{"name", "imu"}, {"kind", "imu"}, {"port", port}, {"mounting_rpy_deg", {0, 0, 0}}},
           {{"name", "gps"},
            {"kind", "gps"},
            {"protocol", protocol},
            {"rate_hz", 5},
            {"port", port},
            {"position_m", {0, 0, 0}}}});
    return load_service_config<GpsBridgeConfig>(with_vehicle({}, path_, "gps_bridge"))
        .value.sensors.at(0)
        .sensor;
  }
  /// As fusion takes it.
  bool heading_is_by_antennas(const json& more) {
    json heading = {{"name", "heading"}, {"kind", "heading"}, {"rate_hz", 5}};
    heading.update(more);
    write({{{"name", "imu"}, {"kind", "imu"}, {"mounting_rpy_deg", {0, 0, 0}}}, heading});
    const auto fusion = load_service_config<FusionConfig>(with_vehicle({}, path_, "fusion")).value;
    return fusion.engine.sensors.at(0).two_antenna;
  }

 private:
  void write(const json& instruments) {
    std::ofstream(path_) << json{{"name", "auv"}, {"instruments", instruments}};
  }

  std::string path_ = ::testing::TempDir() + "protocol_of_a_vehicle.json";
};

TEST_F(ProtocolOfAVehicle, ItsClockIsTheTimeOfTheBridge) {
  for (const codec::Protocol& protocol : codec::protocols()) {
    const auto mode = bridge_of({{"protocol", protocol.name}}).sensor.time.mode;
    EXPECT_EQ(mode, protocol.clock == codec::DeviceClock::counter ? runtime::TimeMode::device_clock
                    : protocol.clock == codec::DeviceClock::utc   ? runtime::TimeMode::device_utc
                                                                  : runtime::TimeMode::arrival)
        << protocol.name;
  }
}

TEST_F(ProtocolOfAVehicle, AReceiverKnowsUtcWhateverTheUnitAroundItCounts) {
  for (const char* protocol :
       {"vectornav", "xsens", "microstrain", "sbg", "nmea0183", "ubx", "novatel", "sbf"}) {
    const SensorConfig receiver = receiver_of(protocol);
    EXPECT_EQ(receiver.time.mode, runtime::TimeMode::device_utc) << protocol;
    EXPECT_TRUE(receiver.source.shared);
  }
  EXPECT_EQ(receiver_of("mavlink").time.mode, runtime::TimeMode::device_clock);
}

TEST_F(ProtocolOfAVehicle, AHeadingOfTwoAntennasIsKnownByItsProtocol) {
  EXPECT_TRUE(heading_is_by_antennas({{"protocol", "ubx"}}));
  EXPECT_TRUE(heading_is_by_antennas({{"protocol", "sbg"}}));
  EXPECT_TRUE(heading_is_by_antennas({{"protocol", "novatel"}}));
  EXPECT_TRUE(heading_is_by_antennas({{"protocol", "sbf"}}));
  EXPECT_FALSE(heading_is_by_antennas({{"protocol", "nmea0183"}}));
  EXPECT_TRUE(heading_is_by_antennas({{"protocol", "nmea0183"}, {"fusion", {{"two_antenna", true}}}}));
}

TEST_F(ProtocolOfAVehicle, AxesThatItsCodecTurnsAreNotTurnedAgain) {
  EXPECT_DOUBLE_EQ(bridge_of({{"protocol", "vectornav"}, {"axes", "flu"}}).mounting.rotation()[4], -1.0);
  EXPECT_DOUBLE_EQ(bridge_of({{"protocol", "xsens"}, {"axes", "flu"}}).mounting.rotation()[4], 1.0);
  EXPECT_DOUBLE_EQ(bridge_of({{"protocol", "xsens"}}).mounting.rotation()[4], 1.0);
  const auto of_a_model = bridge_of({{"model", "xsens_mti630"}});  // the catalogue knows protocol and axes
  EXPECT_EQ(of_a_model.sensor.protocol, "xsens");
  EXPECT_EQ(of_a_model.sensor.time.mode, runtime::TimeMode::device_clock);
  EXPECT_DOUBLE_EQ(of_a_model.mounting.rotation()[4], 1.0);
}

class ModelOfAVehicle : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("FATHOM_CATALOGUE_DIR", (test::source_dir() + "/deploy/config/catalogue").c_str(), 1);
    std::filesystem::create_directories(folder_ / "catalogue");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// A DVL of one's own with this scale error, or with a key that may mean nothing.
  void write_model(const std::string& name, const json& states, const std::string& figure) {
    std::ofstream(folder_ / "catalogue" / (name + ".json"))
        << json{{"title", name},
                {"kind", "dvl"},
                {"protocol", "pd0"},
                {"states", states},
                {"figures", {{"states." + figure, {{"says", "as tried"}, {"source", "page 1"}}}}}};
  }
  /// The states of fusion of a vehicle with DVLs of these models.
  estimation::StateModelConfig states(const std::vector<std::string>& models, const json& services = {}) {
    json instruments = json::array();
    instruments.push_back(placed("imu", "imu"));
    instruments.back()["protocol"] = "vectornav";
    for (const std::string& model : models) {
      instruments.push_back(placed("dvl_" + std::to_string(instruments.size()), "dvl"));
      instruments.back()["model"] = model;
    }
    json file = {{"name", "auv"}, {"instruments", instruments}};
    if (!services.is_null()) file["services"] = services;
    const auto path = (folder_ / "vehicle.json").string();
    std::ofstream(path) << file;
    return load_service_config<FusionConfig>(with_vehicle({}, path, "fusion")).value.engine.states;
  }

 private:
  static json placed(const std::string& name, const std::string& kind) {
    return {{"name", name},
            {"kind", kind},
            {"rate_hz", 5},
            {"port", {{"type", "serial"}, {"path", "/dev/tty_" + name}}},
            {"position_m", {0, 0, 0}},
            {"mounting_rpy_deg", {0, 0, 0}}};
  }
  std::filesystem::path folder_ = std::filesystem::path(::testing::TempDir()) / "model_of_a_vehicle";
};

TEST_F(ModelOfAVehicle, ItsAccuracyIsTheStartOfTheStates) {
  const double standard = estimation::StateModelConfig{}.dvl_scale_sigma;
  EXPECT_DOUBLE_EQ(states({"teledyne_workhorse_navigator"}).dvl_scale_sigma, standard) << "says nothing";
  EXPECT_GT(states({"waterlinked_a50"}).dvl_scale_sigma, 2.0 * standard) << "the standard one is of 1 %";
  const json better = {{"fusion", {{"engine", {{"states", {{"dvl_scale_sigma", 0.001}}}}}}}};
  EXPECT_DOUBLE_EQ(states({"waterlinked_a50"}, better).dvl_scale_sigma, 0.001) << "the vehicle's word holds";
}

TEST_F(ModelOfAVehicle, TheWorseOfTwoHolds) {
  write_model("good", {{"dvl_scale_sigma", 0.001}}, "dvl_scale_sigma");
  write_model("bad", {{"dvl_scale_sigma", 0.02}}, "dvl_scale_sigma");
  EXPECT_DOUBLE_EQ(states({"good"}).dvl_scale_sigma, 0.001);
  EXPECT_DOUBLE_EQ(states({"good", "bad"}).dvl_scale_sigma, 0.02);
  EXPECT_DOUBLE_EQ(states({"bad", "good"}).dvl_scale_sigma, 0.02);
}

TEST_F(ModelOfAVehicle, AStateThatIsNoneIsNamedWithItsFile) {
  write_model("odd", {{"dvl_scale", 0.02}}, "dvl_scale");
  write_model("bare", {{"dvl_scale_sigma", 0.02}}, "dvl_bias_sigma_m_s");
  for (const auto& [model, said] :
       {std::pair{"odd", "catalogue/odd.json: states.dvl_scale"}, {"bare", "catalogue/bare.json"}}) {
    try {
      (void)states({model});
      ADD_FAILURE() << model << " was taken";
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace fathom::config

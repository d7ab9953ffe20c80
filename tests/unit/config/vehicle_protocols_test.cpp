// What the registry says of a protocol decides how a vehicle's bridge stamps and turns its samples.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "codec/registry.hpp"
#include "config/bridge/bridge_config.hpp"
#include "config/service_config.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;

class ProtocolOfAVehicle : public ::testing::Test {
 protected:
  void SetUp() override { setenv("FATHOM_CATALOGUE_DIR", FATHOM_SOURCE_DIR "/deploy/config/catalogue", 1); }
  void TearDown() override { std::filesystem::remove(path_); }

  /// The one inertial unit of a vehicle, as its bridge has it.
  ImuSensorConfig bridge_of(const json& more) {
    json unit = {{"name", "imu"},           {"kind", "imu"},
                 {"rate_hz", 100},          {"port", {{"type", "serial"}, {"path", "/dev/ttyUSB0"}}},
                 {"position_m", {0, 0, 0}}, {"mounting_rpy_deg", {0, 0, 0}}};
    unit.update(more);
    std::ofstream(path_) << json{{"name", "auv"}, {"instruments", json::array({unit})}};
    return load_service_config<ImuBridgeConfig>(with_vehicle({}, path_, "imu_bridge")).value.sensors.at(0);
  }

 private:
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

TEST_F(ProtocolOfAVehicle, AxesThatItsCodecTurnsAreNotTurnedAgain) {
  EXPECT_DOUBLE_EQ(bridge_of({{"protocol", "vectornav"}, {"axes", "flu"}}).mounting.rotation()[4], -1.0);
  EXPECT_DOUBLE_EQ(bridge_of({{"protocol", "xsens"}, {"axes", "flu"}}).mounting.rotation()[4], 1.0);
  EXPECT_DOUBLE_EQ(bridge_of({{"protocol", "xsens"}}).mounting.rotation()[4], 1.0);
  const auto of_a_model = bridge_of({{"model", "xsens_mti630"}});  // the catalogue knows protocol and axes
  EXPECT_EQ(of_a_model.sensor.protocol, "xsens");
  EXPECT_EQ(of_a_model.sensor.time.mode, runtime::TimeMode::device_clock);
  EXPECT_DOUBLE_EQ(of_a_model.mounting.rotation()[4], 1.0);
}

}  // namespace
}  // namespace fathom::config

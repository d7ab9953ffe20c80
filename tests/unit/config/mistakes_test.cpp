// Whoever writes the file of a vehicle hears of all its mistakes at once.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/fusion/fusion_config.hpp"
#include "config/json/error.hpp"
#include "config/service_config.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "support/paths.hpp"

namespace fathom::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

class MistakesOfAVehicle : public ::testing::Test {
 protected:
  void SetUp() override {
    setenv("FATHOM_CATALOGUE_DIR", (test::source_dir() + "/deploy/config/catalogue").c_str(), 1);
    file = ::testing::TempDir() + "mistakes_" +
           ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
  }
  void TearDown() override { std::filesystem::remove(file); }

  /// The mistakes that fusion finds when it is configured by this vehicle, and what is printed of them.
  std::vector<ConfigError> mistakes(const std::string& text) {
    std::ofstream(file) << text;
    try {
      (void)load_service_config<FusionConfig>(with_vehicle({}, file, "fusion"));
    } catch (const ConfigError& error) {
      said = error.what();
      return error.each();
    }
    said = "";
    return {};
  }
  std::vector<std::string> keys(const std::string& text) {
    std::vector<std::string> out;
    for (const ConfigError& one : mistakes(text)) out.push_back(one.key());
    return out;
  }

  std::string file, said;
};

const std::string kImu = R"({"name": "imu", "kind": "imu", "model": "vectornav_vn100",
  "port": {"type": "serial", "path": "/dev/ttyUSB0"}, "position_m": [0, 0, 0], "mounting_rpy_deg": [0, 0, 0]})";

TEST_F(MistakesOfAVehicle, AreAllSaidEachWithItsPlace) {
  const std::string gps = R"({"name": "gps", "kind": "gps", "model": "ublox_f9p", "lever_m": [1, 2, 3],
    "rate_hz": "4", "port": {"type": "tcp"}})";
  const std::string again = R"({"name": "gps", "kind": "gps", "position_m": [0, 0],
    "port": {"type": "serial", "path": "/dev/ttyUSB2"}})";
  EXPECT_THAT(keys(R"({"name": "my car", "instruments": [)" + kImu + "," + gps + "," + again +
                   R"(], "services": {"monitr": {}}})"),
              ElementsAre("instruments.1.lever_m", "instruments.1.port.type", "instruments.1.rate_hz",
                          "instruments.1.position_m", "instruments.2.position_m", "name",
                          "instruments.2.name", "services.monitr", "instruments.1.model"));
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 8);
  EXPECT_THAT(said, HasSubstr("instruments.1.rate_hz: is \"4\", expected a number from 0.001 to 10000\n"));
  EXPECT_THAT(said,
              HasSubstr("\n" + file + ": instruments.2.name: is \"gps\", expected a name that no other"));
  EXPECT_THAT(said, HasSubstr("the nearest is ublox_zed_f9p; "));
}

TEST_F(MistakesOfAVehicle, MakeNoFurtherOnes) {
  // The kind decides which keys there are: none of the others is held against the wrong kind.
  EXPECT_THAT(keys(R"({"name": "auv", "instruments": [)" + kImu +
                   R"(, {"name": "gps", "kind": "gnss", "position_m": [0, 0, 0]}]})"),
              ElementsAre("instruments.1.kind"));
  EXPECT_THAT(keys(R"({"name": "auv"})"), ElementsAre("instruments"));
  EXPECT_THAT(keys(R"({"name": "auv", "instruments": []})"), ElementsAre("instruments"));
  EXPECT_THAT(keys(R"({"name": "auv", "instrumens": []})"), ElementsAre("instrumens"));
  EXPECT_THAT(keys("[]"), ElementsAre("(whole file)"));
}

TEST_F(MistakesOfAVehicle, InKeysOfAServiceAreAllSaidToo) {
  const std::string gps = R"({"name": "gps", "kind": "gps", "position_m": [0, 0, 0],
    "port": {"type": "serial", "path": "/dev/ttyUSB1"}, "fusion": {"sigm_m": 1, "gate": "wide"}})";
  EXPECT_THAT(
      keys(R"({"name": "auv", "instruments": [)" + kImu + "," + gps +
           R"(], "services": {"fusion": {"engin": {}}}})"),
      ElementsAre("services.fusion.engin", "instruments.1.fusion.gate", "instruments.1.fusion.sigm_m"));
}

TEST_F(MistakesOfAVehicle, OfAnotherKindOfFileFillNoScreen) {
  std::string text = "{";
  for (int i = 0; i < 100; ++i) text += "\"strange" + std::to_string(i) + "\": 1, ";
  EXPECT_EQ(mistakes(text + "\"name\": \"auv\"}").size(), 101U);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 20);
  EXPECT_THAT(said, HasSubstr(file + ": and 81 more"));
  const auto known = said.find("known keys: ");
  ASSERT_NE(known, std::string::npos);
  EXPECT_THAT(said.substr(known + 1), Not(HasSubstr("known keys: ")));
}

}  // namespace
}  // namespace fathom::config

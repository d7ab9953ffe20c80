#include "config/fusion/mounting_check.hpp"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/service_config.hpp"

namespace fathom::config {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A folder with fusion's configuration and those of bridges, as on a vehicle.
class MountingCheck : public testing::Test {
 protected:
  MountingCheck()
      : folder_(std::filesystem::path(testing::TempDir()) /
                (std::string("mounting_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~MountingCheck() override { std::filesystem::remove_all(folder_); }

  void write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text;
  }
  void write_imu_bridge(const std::string& name, const std::string& mounting,
                        const std::string& file = "imu_bridge.json") const {
    write(file, R"({"sensors": [{"name": ")" + name +
                    R"(", "source": {"type": "serial", "path": "/dev/x"}, "protocol": "vectornav",
                        "time": {"mode": "arrival"}, "rate_hz": 100, "mounting": )" +
                    mounting + "}]}");
  }
  void write_dvl_bridge(double alignment_deg) const {
    write("dvl_bridge.json", R"({"sensors": [{"name": "dvl", "source": {"type": "serial", "path": "/dev/x"},
      "protocol": "pd0", "time": {"mode": "arrival"}, "rate_hz": 5, "heading_alignment_deg": )" +
                                 std::to_string(alignment_deg) + "}]}");
  }

  /// What is wrong with this fusion among the files of the folder.
  [[nodiscard]] std::string answer(const std::string& imu_rpy_deg,
                                   const std::string& dvl_rpy_deg = "[0, 0, 0]") const {
    const std::string file = (folder_ / "fusion.json").string();
    write("fusion.json", R"({"imu_sensor": "imu1", "engine": {"imu": {"mounting_rpy_deg": )" + imu_rpy_deg +
                             R"(}, "sensors": [{"sensor": "dvl", "kind": "dvl", "lever_B_m": [0, 0, 0],
                             "mounting_rpy_deg": )" +
                             dvl_rpy_deg + "}]}}");
    try {
      refuse_second_mounting(load_service_config<FusionConfig>({file, {}}).value, file);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::filesystem::path folder_;
};

TEST_F(MountingCheck, ATurnOfTheInertialUnitStandsInOnePlace) {
  write_imu_bridge("imu1", R"({"frame": "frd", "rpy_deg": [0, 0, 90]})");
  EXPECT_EQ(answer("[0, 0, 0]"), "accepted");
  EXPECT_EQ(answer("[0, 0, 45]"), (folder_ / "fusion.json").string() +
                                      ": engine.imu.mounting_rpy_deg: is [0, 0, 45], expected [0, 0, 0] "
                                      "because sensors.0.mounting of " +
                                      (folder_ / "imu_bridge.json").string() +
                                      " turns the same instrument, or that one to turn nothing");
}

TEST_F(MountingCheck, ABridgeThatTurnsNothingLeavesItToFusion) {
  write_imu_bridge("imu1", R"({"frame": "frd", "rpy_deg": [0, 0, 0]})");
  EXPECT_EQ(answer("[0, 0, 45]"), "accepted");
  write_imu_bridge("imu1", R"({"frame": "matrix", "R_BS": [1, 0, 0, 0, 1, 0, 0, 0, 1]})");
  EXPECT_EQ(answer("[0, 0, 45]"), "accepted");
}

TEST_F(MountingCheck, FlippedAxesAreATurnAsWell) {
  write_imu_bridge("imu1", R"({"frame": "flu"})");
  EXPECT_THAT(answer("[0, 0, 45]"), HasSubstr("sensors.0.mounting of"));
}

TEST_F(MountingCheck, OtherUnitsDoNotCount) {
  write_imu_bridge("imu2", R"({"frame": "frd", "rpy_deg": [0, 0, 90]})");
  EXPECT_EQ(answer("[0, 0, 45]"), "accepted");
}

TEST_F(MountingCheck, EveryBridgeOfTheKindInTheFolderCounts) {
  write_imu_bridge("imu2", R"({"frame": "frd"})");
  write_imu_bridge("imu1", R"({"frame": "frd", "rpy_deg": [0, 0, 90]})", "imu_bridge_aft.json");
  EXPECT_THAT(answer("[0, 0, 45]"), HasSubstr("imu_bridge_aft.json"));
}

TEST_F(MountingCheck, NoBridgeOrABrokenOneIsNoReasonToRefuse) {
  EXPECT_EQ(answer("[0, 0, 45]"), "accepted");
  write("imu_bridge.json", "{");
  EXPECT_EQ(answer("[0, 0, 45]"), "accepted");
}

TEST_F(MountingCheck, ATurnOfTheVelocityLogStandsInOnePlaceToo) {
  write_dvl_bridge(45.0);
  EXPECT_EQ(answer("[0, 0, 0]"), "accepted");
  EXPECT_THAT(answer("[0, 0, 0]", "[0, 0, 30]"),
              AllOf(HasSubstr("engine.sensors.0.mounting_rpy_deg: is [0, 0, 30]"),
                    HasSubstr("sensors.0.heading_alignment_deg of"), HasSubstr("dvl_bridge.json")));
  write_dvl_bridge(0.0);
  EXPECT_EQ(answer("[0, 0, 0]", "[0, 0, 30]"), "accepted");
}

}  // namespace
}  // namespace fathom::config

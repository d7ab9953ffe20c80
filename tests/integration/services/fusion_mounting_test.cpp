// The whole service: where a mounting stands in fusion's and in a bridge's file, it does not start.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/paths.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(FusionProcess, DoesNotStartWhereAMountingStandsTwice) {
  const TemporaryFolder folder;
  for (const char* name : {"fusion.json", "imu_bridge.json"}) {
    std::ostringstream text;
    text << std::ifstream(std::filesystem::path(source_dir()) / "deploy/config" / name).rdbuf();
    std::string file = text.str();
    const std::string turned = R"("rpy_deg": [0.0, 0.0, 0.0])";
    const auto at = file.find(turned);
    if (at != std::string::npos) file.replace(at, turned.size(), R"("rpy_deg": [0, 0, 180])");
    std::ofstream(folder / name) << file;
  }
  const std::string turn = "engine.imu.mounting_rpy_deg=[0, 0, 90]";
  for (const bool check : {true, false}) {
    std::vector<std::string> arguments{"--config", folder / "fusion.json", "--set", turn};
    if (check) arguments.emplace_back("--check");
    Process fusion("fathom-fusion", arguments);
    EXPECT_EQ(fusion.wait(), 2);
    EXPECT_THAT(fusion.err(), AllOf(HasSubstr("fusion.json: engine.imu.mounting_rpy_deg: is [0, 0, 90]"),
                                    HasSubstr("sensors.0.mounting of"), HasSubstr("imu_bridge.json")));
  }
  Process alone("fathom-fusion", {"--config", folder / "fusion.json", "--check"});
  EXPECT_EQ(alone.wait(), 0) << alone.err();
}

}  // namespace
}  // namespace fathom::test

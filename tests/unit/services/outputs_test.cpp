#include "cli/outputs.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

class Outputs : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"log.mcap", "config.json", "data/imu.csv", "data/import.json"}) {
      fs::create_directories((folder_.path() / name).parent_path());
      std::ofstream(folder_.path() / name) << "content";
    }
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] NamedPath data() const { return {"the input", path("data"), true}; }

  /// The complaint; empty where there is none.
  static std::string complaint(const std::vector<NamedPath>& inputs, const std::vector<NamedPath>& outputs) {
    try {
      refuse_same_files(inputs, outputs);
    } catch (const Failure& failure) {
      EXPECT_EQ(failure.code(), ExitCode::bad_configuration);
      return failure.what();
    }
    return "";
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(Outputs, AnInputIsRefusedByBothNames) {
  EXPECT_EQ(complaint({{"the input", path("log.mcap")}}, {{"--out", path("log.mcap")}}),
            "--out " + path("log.mcap") + ": is the same file as the input " + path("log.mcap") +
                ", expected another one");
  EXPECT_EQ(complaint({{"the input", path("log.mcap")}, {"--config", path("config.json")}},
                      {{"--out", path("nav.csv")}, {"--metrics", path("config.json")}}),
            "--metrics " + path("config.json") + ": is the same file as --config " + path("config.json") +
                ", expected another one");
  EXPECT_EQ(complaint({{"the input", path("log.mcap")}}, {{"--out", path("nav.csv")}}), "");
}

TEST_F(Outputs, NoOtherNameOrLinkHidesIt) {
  const NamedPath input{"the input", path("log.mcap")};
  EXPECT_NE(complaint({input}, {{"--out", path("data/../log.mcap")}}), "");
  fs::create_symlink("log.mcap", path("symbolic"));
  EXPECT_NE(complaint({input}, {{"--out", path("symbolic")}}), "");
  fs::create_hard_link(path("log.mcap"), path("hard"));
  EXPECT_NE(complaint({input}, {{"--out", path("hard")}}), "");
  fs::create_directory_symlink("data", path("elsewhere"));
  EXPECT_NE(complaint({data()}, {{"--out", path("elsewhere/imu.csv")}}), "");
}

TEST_F(Outputs, NoFileOfADataSetIsAnOutputNorOneThatWouldBecomeIt) {
  for (const char* name : {"imu.csv", "imu.csv.gz", "dvl.csv", "reference.csv.gz", "import.json"})
    EXPECT_NE(complaint({data()}, {{"--out", path("data/") + name}}), "") << name;
  for (const char* name : {"nav.csv", "nav.csv.gz", "metrics.json", "page.html"})
    EXPECT_EQ(complaint({data()}, {{"--out", path("data/") + name}}), "") << name;
  EXPECT_NE(complaint({data()}, {{"--out", path("data"), true}}), "");
  EXPECT_EQ(complaint({data()}, {{"--out", path("another"), true}}), "");
  EXPECT_NE(complaint({{"the scenario", path("data/imu.csv")}}, {{"--out", path("data"), true}}), "");
}

TEST_F(Outputs, TwoOutputsAreTwoFilesAlsoBeforeTheyAreThere) {
  EXPECT_EQ(complaint({}, {{"--out", path("a.csv")}, {"--metrics", path("data/../a.csv")}}),
            "--metrics " + path("data/../a.csv") + ": is the same file as --out " + path("a.csv") +
                ", expected another one");
  fs::create_symlink("a.csv", path("dangling"));
  EXPECT_NE(complaint({}, {{"--out", path("dangling")}, {"--metrics", path("a.csv")}}), "");
  EXPECT_EQ(complaint({}, {{"--out", path("a.csv")}, {"--metrics", path("b.csv")}}), "");
  EXPECT_EQ(complaint({}, {{"--out", ""}, {"--metrics", ""}}), "") << "what nobody gave";
}

TEST_F(Outputs, DevicesAndStreamsTakeSeveral) {
  for (const char* stream : {"/dev/null", "/dev/stdout", "/dev/stderr", "/dev/fd/1", "/proc/self/fd/1"})
    EXPECT_EQ(complaint({{"the input", path("log.mcap")}}, {{"--out", stream}, {"--metrics", stream}}), "")
        << stream;
}

}  // namespace
}  // namespace fathom::cli

// What a command writes is never what it reads.
#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "solve_fixture.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

struct SameFile {
  const char* name;
  std::vector<std::string> arguments;  ///< those with a dot or a slash are files of the test's folder
  std::vector<std::string> options;    ///< that the message names
};

class OutputOntoInput : public SolveTest, public ::testing::WithParamInterface<SameFile> {
 protected:
  void SetUp() override {
    SolveTest::SetUp();
    fs::create_directory(folder / "data");
    for (const std::string& name : kFiles) write(name, kContent);
    fs::create_symlink("log.mcap", folder / "link.html");
    fs::create_symlink("data", folder / "again");
  }
  int run_command() {
    std::vector<std::string> arguments;
    for (const std::string& word : GetParam().arguments)
      arguments.push_back(word.find_first_of("./") == std::string::npos ? word : path(word));
    return run("fathom", arguments);
  }
  const std::string kContent = "what somebody needs\n";
  const std::vector<std::string> kFiles{"log.mcap",         "log.ulg",      "nav.csv",
                                        "vehicle.json",     "instants.txt", "imu.csv",
                                        "data/import.json", "data/imu.csv", "data/dvl.csv.gz"};
};

TEST_P(OutputOntoInput, IsRefusedAndNothingIsWritten) {
  const std::string config = content("config.json");
  EXPECT_EQ(run_command(), 2) << err;
  EXPECT_THAT(err, HasSubstr(": is the same file as "));
  for (const std::string& option : GetParam().options) EXPECT_THAT(err, HasSubstr(option));
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  EXPECT_EQ(out, "");
  for (const std::string& name : kFiles) EXPECT_EQ(content(name), kContent) << name;
  EXPECT_EQ(content("config.json"), config);
  EXPECT_FALSE(fs::exists(folder / "fresh.csv"));
}

INSTANTIATE_TEST_SUITE_P(
    Table, OutputOntoInput,
    ::testing::Values(
        SameFile{"solve", {"solve", "log.mcap", "--out", "log.mcap"}, {"--out ", "the input "}},
        SameFile{"solve_compressed",
                 {"solve", "data/", "--config", "config.json", "--out", "data/imu.csv.gz"},
                 {"--out ", "the input "}},
        SameFile{"solve_onto_a_sensor",
                 {"solve", "data/", "--config", "config.json", "--out", "again/imu.csv"},
                 {"--out ", "the input "}},
        SameFile{"solve_onto_its_configuration",
                 {"solve", "data/", "--config", "config.json", "--out", "config.json"},
                 {"--out ", "--config "}},
        SameFile{"solve_onto_its_vehicle",
                 {"solve", "data/", "--vehicle", "vehicle.json", "--out", "fresh.csv", "--metrics",
                  "vehicle.json"},
                 {"--metrics ", "--vehicle "}},
        SameFile{
            "solve_onto_its_instants",
            {"solve", "data/", "--config", "config.json", "--at", "instants.txt", "--out", "instants.txt"},
            {"--out ", "--at "}},
        SameFile{
            "solve_twice_onto_one",
            {"solve", "data/", "--config", "config.json", "--out", "fresh.csv", "--metrics", "fresh.csv"},
            {"--out ", "--metrics "}},
        SameFile{"solve_calibration",
                 {"solve", "data/", "--config", "config.json", "--out", "fresh.csv", "--calibrate-hydro",
                  "config.json"},
                 {"--calibrate-hydro ", "--config "}},
        SameFile{"compare_csv",
                 {"solve", "log.mcap", "--compare", "config.json", "--csv", "log.mcap"},
                 {"--csv ", "the input "}},
        SameFile{"compare_page",
                 {"solve", "log.mcap", "--compare", "config.json", "--page", "config.json"},
                 {"--page ", "--compare "}},
        SameFile{"report", {"report", "log.mcap", "--out", "link.html"}, {"--out ", "the input "}},
        SameFile{"report_of_a_data_set",
                 {"report", "data/", "--config", "config.json", "--out", "data/imu.csv"},
                 {"--out ", "the input "}},
        SameFile{"plot", {"plot", "nav.csv", "sigma_n_m", "--out", "nav.csv"}, {"--out ", "the input "}},
        SameFile{"commission", {"commission", "log.mcap", "--page", "log.mcap"}, {"--page ", "the input "}},
        SameFile{"commission_vehicle",
                 {"commission", "data/", "--vehicle", "vehicle.json", "--page", "vehicle.json"},
                 {"--page ", "--vehicle "}},
        SameFile{"export_kml",
                 {"export", "log.mcap", "--format", "kml", "--out", "log.mcap"},
                 {"--out ", "the input "}},
        SameFile{"export_kml_onto_a_sensor",
                 {"export", "data/", "--format", "kml", "--out", "data/imu.csv"},
                 {"--out ", "the input "}},
        SameFile{"export_csv_onto_itself",
                 {"export", "data/", "--format", "csv", "--out", "again/"},
                 {"--out ", "the input "}},
        SameFile{"export_solution_onto_itself",
                 {"export", "nav.csv", "--format", "csv", "--out", "./"},
                 {"--out ", "the input "}},
        SameFile{"import", {"import", "imu.csv", "--out", "./"}, {"--out ", "the input "}},
        SameFile{"simulate", {"simulate", "imu.csv", "--out", "./"}, {"--out ", "the scenario "}}),
    [](const auto& info) { return std::string(info.param.name); });

TEST_F(SolveTest, OneDeviceTakesAllThatIsWritten) {
  dataset::write(path("data"), StraightCourse(false).data);
  for (const char* device : {"/dev/null", "/dev/stdout"}) {
    EXPECT_EQ(run("fathom", {"solve", path("data"), "--config", path("config.json"), "--start", "reference",
                             "--out", device, "--metrics", device}),
              0)
        << err;
  }
}

}  // namespace
}  // namespace fathom::test

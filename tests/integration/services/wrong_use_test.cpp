// What is wrong is said with the exit code of its kind: 2 use, 3 input, 4 system. No option is passed over.
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "samples/kinds.hpp"
#include "solve_fixture.hpp"

namespace fathom::test {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;

struct WrongCall {
  const char* name;
  std::vector<std::string> arguments;  ///< "@" is the test's folder
  int code;
  const char* message;
};

class WrongUse : public SolveTest, public ::testing::WithParamInterface<WrongCall> {
 protected:
  void SetUp() override {
    SolveTest::SetUp();
    fs::create_directory(folder / "empty");
    fs::create_directory(folder / "full");
    fs::create_symlink("/dev/full", folder / "full/nav.csv");
    write("nav.csv", "t_s,a\n1,2\n");
    write("instants.txt", "1\n2\n");
    write("log.ulg", "ULog\x01\x12\x35\x01"s + std::string(8, '\0'));
  }
};

TEST_P(WrongUse, EndsWithItsCodeAndOneLine) {
  std::vector<std::string> arguments = GetParam().arguments;
  for (std::string& word : arguments)
    if (word.starts_with("@")) word = folder.string() + word.substr(1);
  EXPECT_EQ(run("fathom", arguments), GetParam().code) << out << err;
  EXPECT_THAT(err, HasSubstr(GetParam().message));
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
}

INSTANTIATE_TEST_SUITE_P(
    Network, WrongUse,
    ::testing::Values(
        WrongCall{"peer", {"status", "--peer", "abc"}, 2, "peer 'abc': expected an IPv4 address"},
        WrongCall{"server", {"status", "--discovery-server", "abc"}, 2, "discovery server 'abc': expected"},
        WrongCall{"profiles", {"status", "--profiles", "/nope"}, 2, "no QoS profiles"},
        WrongCall{
            "endless_wait", {"status", "--timeout", "nan"}, 2, "--timeout: is nan, expected a finite number"},
        WrongCall{"depth_sigma",
                  {"fix", "--lat", "1", "--lon", "1", "--sigma", "1", "--depth-sigma", "5"},
                  2,
                  "--depth-sigma requires --depth"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Files, WrongUse,
    ::testing::Values(
        WrongCall{
            "recover_of_nothing", {"record", "--recover", ""}, 2, "--recover: is empty, expected a value"},
        WrongCall{"replay_of_a_range_backwards",
                  {"replay", "@/nope.mcap", "--from", "100", "--to", "50"},
                  2,
                  "--to 50: expected more than --from, which is 100"},
        WrongCall{"solution_of_what_is_not_there",
                  {"solve", "@/nope", "--out", "@/out.csv"},
                  3,
                  "nope: No such file or directory, expected the folder of a data set"},
        WrongCall{"solution_of_a_text",
                  {"solve", "@/nav.csv", "--out", "@/out.csv"},
                  3,
                  "nav.csv: is no folder, expected the folder of a data set"},
        WrongCall{"report_on_what_is_not_there",
                  {"report", "@/nope", "--out", "@/out.html"},
                  3,
                  "nope: No such file or directory"},
        WrongCall{"replay_of_nothing", {"replay", "@/nope.mcap"}, 3, "nope.mcap"},
        WrongCall{"proof_of_a_part",
                  {"replay", "@/nope.mcap", "--verify", "--from", "1"},
                  2,
                  "--from excludes --verify"},
        WrongCall{"proof_at_a_speed",
                  {"replay", "@/nope.mcap", "--verify", "--speed", "2"},
                  2,
                  "--speed excludes --verify"},
        WrongCall{
            "proof_again", {"replay", "@/nope.mcap", "--verify", "--loop"}, 2, "--loop excludes --verify"},
        WrongCall{"seed",
                  {"simulate", "flight", "--seed", "-1", "--out", "@/out"},
                  2,
                  "--seed: is -1, expected a whole number"},
        WrongCall{"study_seed",
                  {"study", "scenarios", "--seed", "-1"},
                  2,
                  "--seed: is -1, expected a whole number"},
        WrongCall{"instants_and_rate",
                  {"solve", "@/empty", "--config", "@/config.json", "--out", "@/out.csv", "--at",
                   "@/instants.txt", "--rate", "9"},
                  2,
                  "--rate excludes --at"},
        WrongCall{"no_inertial_file",
                  {"solve", "@/empty", "--config", "@/config.json", "--out", "@/out.csv"},
                  3,
                  "imu.csv: is not there"},
        WrongCall{"no_inertial_file_to_commission", {"commission", "@/empty"}, 3, "imu.csv: is not there"},
        WrongCall{"nothing_to_override",
                  {"commission", "@/empty", "--set", "nope=1"},
                  2,
                  "--set needs --vehicle or --config"},
        WrongCall{"export_rate",
                  {"export", "@/nav.csv", "--format", "csv", "--out", "@/out", "--rate", "1"},
                  2,
                  "--rate: csv has every row"},
        WrongCall{"export_track",
                  {"export", "@/nav.csv", "--format", "csv", "--out", "@/out", "--track", "nav"},
                  2,
                  "--track: csv has every row"},
        WrongCall{"export_of_nothing",
                  {"export", "@/empty", "--format", "csv", "--out", "@/out"},
                  3,
                  "empty: no samples, expected a data set"},
        WrongCall{"export_to_a_full_disk",
                  {"export", "@/nav.csv", "--format", "csv", "--out", "@/full"},
                  4,
                  "nav.csv: cannot be written: No space left on device"},
        WrongCall{"axes_of_px4",
                  {"import", "@/log.ulg", "--out", "@/out", "--axes", "foo=frd"},
                  2,
                  "--axes: is for bags of ROS 2"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Keygen, WrongUse,
    ::testing::Values(WrongCall{"no_place", {"keygen", "/proc/nope"}, 4, "/proc/nope: cannot be made"},
                      WrongCall{"long_name",
                                {"keygen", "@/keys", "--vehicle", "a2345678901234567890123456789012"},
                                2,
                                "expected 1 to 31 letters"},
                      WrongCall{"check_of_another",
                                {"keygen", "@/keys", "--check", "--vehicle", "bob"},
                                2,
                                "--vehicle excludes --check"},
                      WrongCall{"check_of_days",
                                {"keygen", "@/keys", "--check", "--days", "9"},
                                2,
                                "--days excludes --check"},
                      WrongCall{"renewed_for_domains",
                                {"keygen", "@/keys", "--rotate", "--domains", "1", "2"},
                                2,
                                "--domains excludes --rotate"}),
    [](const auto& info) { return info.param.name; });

TEST_F(SolveTest, HelpNamesEverySensorOfTheTable) {
  ASSERT_EQ(run("fathom", {"solve", "--help"}), 0);
  const std::size_t list = out.find("and any of ");
  ASSERT_NE(list, std::string::npos);
  const std::string names = " " + out.substr(list, out.find('(', list) - list);
  for_each_kind([&](auto kind) {
    const std::string name = " " + std::string(kind.kWord) + ",";
    EXPECT_EQ(names.find(name) != std::string::npos, kind.kSource != SourceKind::imu) << name;
  });
  EXPECT_THAT(names, HasSubstr(" reference "));
}

TEST_F(SolveTest, AnInputThatIsNotGoodLeavesTheSolutionBefore) {
  dataset::write(path("data"), StraightCourse(false).data);
  write("nav.csv", "of an earlier run\n");
  write("instants.txt", "1\nsoon\n");
  EXPECT_EQ(solve({"--start", "reference", "--at", path("instants.txt")}), 3);
  EXPECT_THAT(err, HasSubstr("instants.txt:2: "));
  EXPECT_EQ(content("nav.csv"), "of an earlier run\n");
  EXPECT_EQ(solve({"--start", "reference", "--calibrate-hydro", path("found.json")}), 2);
  EXPECT_EQ(content("nav.csv"), "of an earlier run\n");
}

}  // namespace
}  // namespace fathom::test

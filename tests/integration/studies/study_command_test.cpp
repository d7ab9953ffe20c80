// `fathom study` as scripts use it: the rows, their independence of the number of threads, exit codes.
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "support/paths.hpp"

namespace fathom {
namespace {

using Json = nlohmann::json;

struct Answer {
  int code = -1;
  std::string text;  ///< standard output and error
};

Answer run(const std::string& arguments) {
  const std::string command = test::binary_dir() + "/bin/fathom study " + arguments + " 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  Answer answer;
  if (pipe == nullptr) return answer;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    answer.text.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  answer.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return answer;
}

class StudyCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    // The build makes it before this test: its absence is a failure, not a reason to skip.
    ASSERT_TRUE(std::filesystem::exists(test::binary_dir() + "/bin/fathom"));
    file_ = std::filesystem::temp_directory_path() / ("fathom_study_" + std::to_string(::getpid()) + ".json");
  }
  void TearDown() override { std::filesystem::remove(file_); }

  [[nodiscard]] Json rows(const std::string& arguments) const {
    const Answer answer = run(arguments + " --json " + file_.string());
    EXPECT_EQ(answer.code, 0) << answer.text;
    return Json::parse(std::ifstream(file_));
  }
  /// Mean of a metric; a test failure where there is no such row.
  static double mean(const Json& report, const std::string& method, const std::string& metric) {
    for (const Json& row : report.at("rows"))
      if (row.at("method") == method && row.at("metric") == metric) return row.at("mean").get<double>();
    ADD_FAILURE() << method << " " << metric;
    return 0.0;
  }

  std::filesystem::path file_;
};

TEST_F(StudyCommand, RotatingArmIsTheSameWithAnyNumberOfThreads) {
  const std::string what =
      "rotating_arm --runs 2 --seed 7 --case speed_1.5 --method dead_reckoning "
      "--method imu_only --method full";
  const Json one = rows(what + " --threads 1");
  EXPECT_EQ(one, rows(what + " --threads 2"));
  EXPECT_EQ(one.size(), 5U);  // study, runs, seed, version, rows
  EXPECT_EQ(one.at("study"), "rotating_arm");
  EXPECT_EQ(one.at("runs"), 2);
  EXPECT_EQ(one.at("seed"), 7);
  EXPECT_FALSE(one.at("version").get<std::string>().empty());
  const std::set<std::string> expected{"case", "method", "metric", "unit", "n",   "missing", "mean",
                                       "std",  "rms",    "median", "p05",  "p95", "max"};
  for (const Json& row : one.at("rows")) {
    std::set<std::string> keys;
    for (const auto& item : row.items()) keys.insert(item.key());
    EXPECT_EQ(keys, expected);
    EXPECT_EQ(row.at("case"), "speed_1.5");
    EXPECT_EQ(row.at("n"), 2);
  }
}

TEST_F(StudyCommand, SaysWhatIsWrong) {
  const Answer study = run("moon_landing");
  EXPECT_EQ(study.code, 2);
  EXPECT_THAT(study.text, testing::HasSubstr("moon_landing"));
  EXPECT_THAT(study.text, testing::HasSubstr("rotating_arm"));
  const Answer one = run("rotating_arm --case speed_9");
  EXPECT_EQ(one.code, 2);
  EXPECT_THAT(one.text, testing::HasSubstr("case: speed_9: expected one of speed_0.5"));
  const Answer method = run("rotating_arm --method magic");
  EXPECT_EQ(method.code, 2);
  EXPECT_THAT(method.text, testing::HasSubstr("method: magic"));
  EXPECT_EQ(run("rotating_arm --runs 0").code, 2);
  EXPECT_EQ(run("").code, 2);
  EXPECT_EQ(run("rotating_arm --runs 1 --json /nowhere/at/all.json").code, 4);
}

TEST_F(StudyCommand, ScenariosThatAreNotThereAreAnError) {
  const auto empty = std::filesystem::path(file_).replace_extension(".empty");
  std::filesystem::create_directory(empty);
  ::setenv("FATHOM_SCENARIO_DIR", empty.c_str(), 1);
  const Answer answer = run("scenarios");
  ::unsetenv("FATHOM_SCENARIO_DIR");
  std::filesystem::remove(empty);
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.text, testing::HasSubstr(empty.string()));
}

}  // namespace
}  // namespace fathom

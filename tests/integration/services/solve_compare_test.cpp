// `fathom solve --compare`: two solutions of one data set side by side.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solve_fixture.hpp"
#include "support/paths.hpp"

namespace fathom::test {
namespace {

class CompareTest : public SolveTest {
 protected:
  int compare(std::vector<std::string> more) {
    std::vector<std::string> arguments{"solve",   path("data"), "--config", path("config.json"),
                                       "--start", "reference",  "--json",   "--compare"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process process("fathom", arguments);
    const int code = process.wait();
    out = process.out();
    err = process.err();
    return code;
  }
  [[nodiscard]] nlohmann::json answer() const { return nlohmann::json::parse(out); }
};

TEST_F(CompareTest, TheSameSettingsGiveNoDifferenceAtAll) {
  dataset::write(path("data"), StraightCourse(true).data);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {path("config.json")}, {"--set", "engine.sensors.gps0.enabled=true"}}) {
    ASSERT_EQ(compare(more), 0) << err;
    const auto found = answer();
    EXPECT_EQ(found["equal"], true);
    EXPECT_EQ(found["compared"], 6001);
    EXPECT_EQ(found["changed"], 0);
    EXPECT_EQ(found["measurements"], 121 + 60);
    EXPECT_EQ(found["difference"]["horizontal_m"]["max"], 0.0);
    EXPECT_EQ(found["difference"]["yaw_deg"]["max"], 0.0);
    EXPECT_EQ(found["errors_against"], "the reference");
    EXPECT_EQ(found["first"]["error"], found["second"]["error"]);
  }
}

TEST_F(CompareTest, ASourceLeftOutForATimeIsAllThatChanges) {
  dataset::write(path("data"), StraightCourse(true).data);
  ASSERT_EQ(
      compare({"--without", "gps@20:30", "--csv", path("c.csv"), "--page", path("c.html"), "--rate", "10"}),
      0)
      << err;
  const auto found = answer();
  EXPECT_EQ(found["equal"], false);
  EXPECT_EQ(found["changed"], 20);  // two a second for ten seconds
  ASSERT_EQ(found["runs"].size(), 1U) << found["runs"].dump(2);
  const auto& run = found["runs"][0];
  EXPECT_EQ(run["sensor"], "gps0");
  EXPECT_EQ(run["first"], "used");
  EXPECT_EQ(run["second"], nullptr);
  EXPECT_EQ(run["begin_s"], 20.0);
  EXPECT_NEAR(run["end_s"].get<double>(), 29.5, 1e-9);
  EXPECT_EQ(run["count"], 20);
  EXPECT_GT(found["second"]["horizontal_sigma_m"]["rms"].get<double>(),
            found["first"]["horizontal_sigma_m"]["rms"].get<double>());

  std::istringstream rows(content("c.csv"));
  std::string line;
  std::getline(rows, line);
  int count = 0;
  int apart = 0;
  while (std::getline(rows, line)) {
    ++count;
    const double t_s = std::stod(line);
    const bool differs =
        line.find(",0.000000,0.000000,0.000000,0.000000,0.000000,0.000000,") != line.find(',');
    EXPECT_FALSE(differs && t_s < 19.9) << line;
    apart += differs ? 1 : 0;
  }
  EXPECT_EQ(count, 601);
  EXPECT_GT(apart, 0);
  const std::string page = content("c.html");
  EXPECT_NE(page.find("Verdicts that changed"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  const std::string first = out;
  ASSERT_EQ(compare({"--without", "gps@20:30", "--page", path("c.html")}), 0) << err;
  EXPECT_EQ(out, first);
  EXPECT_EQ(content("c.html"), page);
}

TEST_F(CompareTest, ASourceSwitchedOffIsSaidForEachOfItsMeasurements) {
  dataset::write(path("data"), StraightCourse(true).data);
  ASSERT_EQ(compare({"--set", "engine.sensors.dvl0.enabled=false"}), 0) << err;
  const auto found = answer();
  std::uint64_t disabled = 0;
  for (const auto& change : found["changes"])
    if (change["sensor"] == "dvl0" && change["second"] == "source_disabled") ++disabled;
  EXPECT_EQ(disabled, 60U);
  EXPECT_EQ(found["changed"], 60);
}

TEST_F(CompareTest, WithoutAReferenceTheSmootherIsTheMeasure) {
  Process simulate("fathom",
                   {"simulate", "survey", "--out", path("data"), "--duration", "120", "--seed", "4"});
  ASSERT_EQ(simulate.wait(), 0) << simulate.err();
  const auto solve_twice = [&] {
    Process process("fathom", {"solve", path("data"), "--config", source_dir() + "/deploy/config/fusion.json",
                               "--json", "--compare", "--without", "dvl@60:100"});
    EXPECT_EQ(process.wait(), 0) << process.err();
    out = process.out();
    return answer();
  };
  const auto by_reference = solve_twice();
  fs::remove(folder / "data" / "reference.csv");
  const auto by_smoother = solve_twice();
  EXPECT_EQ(by_reference["errors_against"], "the reference");
  EXPECT_EQ(by_smoother["errors_against"], "the smoother over the first settings");
  EXPECT_EQ(by_smoother["difference"], by_reference["difference"]);
  EXPECT_EQ(by_smoother["runs"], by_reference["runs"]);
  EXPECT_GT(by_smoother["second"]["error"]["count"].get<int>(), 10'000);
  // What the second lost shows against either.
  for (const auto& found : {by_reference, by_smoother})
    EXPECT_GT(found["second"]["error"]["horizontal_m"]["rms"].get<double>(),
              found["first"]["error"]["horizontal_m"]["rms"].get<double>());
}

TEST_F(CompareTest, BadCallsAreOneSentence) {
  dataset::write(path("data"), StraightCourse(true).data);
  const std::vector<std::pair<std::vector<std::string>, std::string>> calls{
      {{"--without", "gsp"}, "--without: is 'gsp', expected a source of the data: "},
      {{"--without", "gps@5"}, "expected SOURCE or SOURCE@FROM:TO"},
      {{"--without", "gps@9:5"}, "expected SOURCE or SOURCE@FROM:TO"},
      {{"--without", "gps@a:5"}, "expected SOURCE or SOURCE@FROM:TO"},
      {{"--set", "engine.horizn_s=3"}, "no such key; the nearest is horizon_s"},
      {{"--set", "engine.sensors.gps7.enabled=false"}, "or the name of a sensor that stands there"},
      {{path("nothing.json")}, "nothing.json: cannot be read"},
      {{"--smooth"}, "--smooth excludes --compare"},
      {{"--out", path("nav.csv")}, "--out excludes --compare"},
  };
  for (const auto& [more, message] : calls) {
    EXPECT_EQ(compare(more), 2) << message;
    EXPECT_NE(err.find(message), std::string::npos) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
  }
}

}  // namespace
}  // namespace fathom::test

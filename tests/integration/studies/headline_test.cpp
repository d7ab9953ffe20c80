// The figures of tests/RESULTS.md, guarded: ten runs each of seeds that the figures were not made with, held
// against the limits of tests/measurements.json. Limits of errors are near twice the published figure.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "support/paths.hpp"
#include "support/sanitized.hpp"

namespace fathom {
namespace {

using Json = nlohmann::json;

constexpr int kRuns = 10;

/// "case method metric" -> row of one run of the command.
using Rows = std::map<std::string, Json>;

Rows rows_of(const std::string& arguments, int runs = kRuns) {
  const auto file =
      std::filesystem::temp_directory_path() / ("fathom_headline_" + std::to_string(::getpid()) + ".json");
  const std::string command = test::binary_dir() + "/bin/fathom study " + arguments + " --runs " +
                              std::to_string(runs) + " --seed 7 --json " + file.string() + " >/dev/null";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command;
  Rows out;
  std::ifstream text(file);
  const Json report = Json::parse(text);
  for (const Json& row : report.at("rows"))
    out[row.at("case").get<std::string>() + " " + row.at("method").get<std::string>() + " " +
        row.at("metric").get<std::string>()] = row;
  std::filesystem::remove(file);
  for (const auto& [name, row] : out) {
    if (row.at("metric") != "failed") continue;
    EXPECT_EQ(row.at("mean"), 0.0) << name;
  }
  return out;
}

double mean(const Rows& rows, const std::string& name) {
  const auto found = rows.find(name);
  if (found == rows.end() || !found->second.at("mean").is_number()) {
    ADD_FAILURE() << name << ": no such row";
    return std::nan("");
  }
  return found->second.at("mean").get<double>();
}

/// Mean NEES of independent runs of `freedom` degrees of freedom each: where 99.9 % of such means lie.
std::pair<double, double> nees_band(int freedom, double runs) {
  const boost::math::chi_squared sum(freedom * runs);
  return {quantile(sum, 0.0005) / runs, quantile(sum, 0.9995) / runs};
}

/// "< x", "> x", "a to b" or "nees K", as tests/measurements.json writes limits.
std::pair<double, double> band(const std::string& limit, double runs) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::istringstream words(limit);
  std::string first;
  double value = 0.0;
  words >> first;
  if (first == "<" && words >> value) return {-kInfinity, value};
  if (first == ">" && words >> value) return {value, kInfinity};
  if (first == "nees" && words >> value) return nees_band(static_cast<int>(value), runs);
  std::string to;
  if (words >> to >> value && to == "to") return {std::stod(first), value};
  ADD_FAILURE() << limit << ": no limit";
  return {kInfinity, -kInfinity};
}

/// Every figure that tests/RESULTS.md publishes of `study` with a limit keeps it in `rows`, where the case
/// was run.
void expect_limits(const Rows& rows, const std::string& study) {
  std::ifstream text(test::source_dir() + "/tests/measurements.json");
  int compared = 0;
  const Json measurements = Json::parse(text);
  for (const Json& row : measurements.at(study).at("rows")) {
    if (!row.contains("limit")) continue;
    const std::string name = row.at("case").get<std::string>() + " " + row.at("metric").get<std::string>();
    const auto found = rows.find(name);
    if (found == rows.end()) continue;
    ++compared;
    const Json& value = found->second.at(row.value("of", "mean"));
    const std::string limit = row.at("limit").get<std::string>();
    if (!value.is_number()) {
      ADD_FAILURE() << name << ": no result, limit " << limit;
      continue;
    }
    const auto [low, high] = band(limit, found->second.at("n").get<double>());
    EXPECT_GE(value.get<double>(), low) << name << " " << limit;
    EXPECT_LE(value.get<double>(), high) << name << " " << limit;
  }
  EXPECT_GT(compared, 0) << study;
}

class Headline : public ::testing::Test {
 protected:
  void SetUp() override { FATHOM_MANY_RUNS(); }
};

TEST_F(Headline, RotatingArm) {
  const Rows rows = rows_of("rotating_arm --case speed_1.5");
  expect_limits(rows, "rotating_arm");
  // The states are worth what is left when the settings are equal.
  EXPECT_LT(2.0 * mean(rows, "speed_1.5 full horizontal_end_error"),
            mean(rows, "speed_1.5 hybrid25_equal horizontal_end_error"));
}

TEST_F(Headline, Survey) {
  expect_limits(
      rows_of("survey --method full --case tactical_straight --case tactical_straight_course_90_off "
              "--case tactical_straight_3_sigma --case tactical_lawn"),
      "survey");
}

TEST_F(Headline, GpsOutage) {
  expect_limits(rows_of("gps_outage --method fixed_gain_hold --method ekf36 --case climb_10s --case bank_10s "
                        "--case dutch_10s --case aided --case random"),
                "gps_outage");
}

TEST_F(Headline, Alignment) {
  expect_limits(rows_of("alignment --method fine --case +10+10 --case -10-10 --case roll_30 "
                        "--case turn_6dps --case vibration_20mg"),
                "alignment");
}

TEST_F(Headline, Hydro) {
  expect_limits(rows_of("hydro --case perfect --case dvl_loss_300s --case dvl_loss_300s_coeff_30pct --case "
                        "dvl_loss_300s_straight --method ins_dvl --method linked --method engine "
                        "--method engine_no_model"),
                "hydro");
}

/// The NEES of every named configuration in some cells, within the limits of all cells as far as these runs
/// can tell.
TEST_F(Headline, Consistency) {
  const Rows rows = rows_of(
      "consistency --case auv_lawn_tactical --case auv_under_way_industrial --case boat_swell_consumer "
      "--case plane_straight_consumer --case plane_banks_consumer --case plane_aerobatic_industrial "
      "--case car_highway_tactical");
  const std::map<std::string, double> expected{
      {"nees_tilt", 2.0}, {"nees_heading", 1.0}, {"nees_velocity", 3.0}, {"nees_position", 3.0}};
  int compared = 0;
  for (const auto& [name, row] : rows) {
    const auto found = expected.find(row.at("metric").get<std::string>());
    if (found == expected.end()) continue;
    ++compared;
    const double mean = row.at("mean").get<double>();
    // Of so few runs the spread is not known either.
    const auto n = row.at("n").get<double>();
    const double quantile = boost::math::quantile(boost::math::students_t(n - 1.0), 0.9995);
    const double doubt = quantile * row.at("std").get<double>() / std::sqrt(n);
    EXPECT_GT(mean, 0.7 * found->second - doubt) << name;
    EXPECT_LT(mean, 1.5 * found->second + doubt) << name;
    EXPECT_LT(mean, 3.0 * found->second) << name;
  }
  EXPECT_EQ(compared, 7 * 3 * 4);
}

// The handover of an air drop is drawn at its sigmas, its hull at 10 %.
TEST_F(Headline, AirDropFromDrawnHandovers) {
  const Rows rows = rows_of("scenarios --case air_drop", 50);
  expect_limits(rows, "scenarios");
  EXPECT_LT(rows.at("air_drop fusion horizontal_rms").at("median").get<double>(), 45.0);
}

// The hull is drawn at 30 % and does what the estimator's model does not know of.
TEST_F(Headline, DvlLossWithDrawnHulls) {
  expect_limits(rows_of("scenarios --case dvl_loss", 20), "scenarios");
}

TEST_F(Headline, RangesToBeacons) {
  expect_limits(rows_of("scenarios --case beacons", 20), "scenarios");
}

// Each scenario of the demonstration, through device bytes and codecs, keeps the limits that it ships with.
TEST_F(Headline, ScenariosKeepTheirLimits) {
  const Rows rows = rows_of("scenarios");
  for (const char* name : {"survey", "air_drop", "flight", "rotating_arm", "dvl_loss", "beacons"}) {
    std::ifstream file(test::source_dir() + "/deploy/config/scenarios/" + name + ".json");
    const Json limits = Json::parse(file).at("limits");
    const std::string one = std::string(name) + " fusion ";
    EXPECT_EQ(mean(rows, one + "aligned"), 1.0) << name;
    const auto keeps = [&](const std::string& metric, const char* limit) {
      EXPECT_LT(rows.at(one + metric).at("median").get<double>(), 0.75 * limits.at(limit).get<double>())
          << name << " " << metric;
    };
    keeps("horizontal_rms", "horizontal_rms_m");
    keeps("horizontal_max", "horizontal_max_m");
    keeps("roll_pitch_rms", "roll_pitch_rms_deg");
    keeps("yaw_rms", "yaw_rms_deg");
    keeps("time_to_aligned", "aligned_within_s");
  }
}

}  // namespace
}  // namespace fathom

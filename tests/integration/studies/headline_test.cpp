// The figures that README publishes, guarded: ten runs each of seeds that the figures were not made with.
// Limits of errors are near twice the published figure; a mean NEES must lie where 99.9 % of such means lie.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include <boost/math/distributions/chi_squared.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom {
namespace {

using Json = nlohmann::json;

constexpr int kRuns = 10;

/// "case method metric" -> row of one run of the command.
using Rows = std::map<std::string, Json>;

Rows rows_of(const std::string& arguments, int runs = kRuns) {
  const auto file =
      std::filesystem::temp_directory_path() / ("fathom_headline_" + std::to_string(::getpid()) + ".json");
  const std::string command = std::string(FATHOM_BINARY_DIR) + "/bin/fathom study " + arguments + " --runs " +
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

/// Mean NEES of independent runs of `freedom` degrees of freedom each.
void expect_consistent(const Rows& rows, const std::string& name, int freedom, int runs = kRuns) {
  const boost::math::chi_squared sum(freedom * runs);
  EXPECT_GT(mean(rows, name), quantile(sum, 0.0005) / runs) << name;
  EXPECT_LT(mean(rows, name), quantile(sum, 0.9995) / runs) << name;
}

TEST(Headline, RotatingArm) {
  const Rows rows = rows_of("rotating_arm --case speed_1.5");
  EXPECT_LT(mean(rows, "speed_1.5 imu_only perfect_imu_error"), 0.0004);
  EXPECT_GT(mean(rows, "speed_1.5 imu_only horizontal_end_error"), 1200.0);
  EXPECT_NEAR(mean(rows, "speed_1.5 dead_reckoning horizontal_end_error"), 63.5, 1.5);
  EXPECT_LT(mean(rows, "speed_1.5 hybrid25 horizontal_end_error"), 1.2);
  EXPECT_LT(mean(rows, "speed_1.5 hybrid25_equal horizontal_end_error"), 0.55);
  EXPECT_LT(mean(rows, "speed_1.5 full horizontal_end_error"), 0.2);
  EXPECT_LT(mean(rows, "speed_1.5 full rmse_over_pcrlb"), 1.6);
  expect_consistent(rows, "speed_1.5 full nees_horizontal", 2);
  // The states are worth what is left when the settings are equal.
  EXPECT_LT(2.0 * mean(rows, "speed_1.5 full horizontal_end_error"),
            mean(rows, "speed_1.5 hybrid25_equal horizontal_end_error"));
}

TEST(Headline, Survey) {
  const Rows rows = rows_of(
      "survey --method full --case tactical_straight --case tactical_straight_course_90_off "
      "--case tactical_straight_3_sigma --case tactical_lawn");
  EXPECT_LT(mean(rows, "tactical_straight full end_error_percent"), 0.17);
  EXPECT_LT(mean(rows, "tactical_straight_course_90_off full end_error_percent"), 0.3);
  EXPECT_LT(mean(rows, "tactical_straight_3_sigma full end_error_percent"), 0.17);
  EXPECT_LT(mean(rows, "tactical_lawn full end_error_percent"), 0.05);
  for (const char* one :
       {"tactical_straight", "tactical_straight_course_90_off", "tactical_straight_3_sigma", "tactical_lawn"})
    expect_consistent(rows, std::string(one) + " full nees_horizontal", 2);
  EXPECT_LT(rows.at("tactical_straight_3_sigma full dvl_scale_error").at("rms").get<double>(), 0.4);
  EXPECT_LT(rows.at("tactical_straight_3_sigma full dvl_misalignment_error").at("rms").get<double>(), 0.18);
}

TEST(Headline, GpsOutage) {
  const Rows rows = rows_of(
      "gps_outage --method fixed_gain_hold --method ekf36 --case climb_10s --case bank_10s --case dutch_10s "
      "--case aided --case random");
  for (const auto& [name, limit_m] : {std::pair("climb_10s", 3.6), {"bank_10s", 4.0}, {"dutch_10s", 3.8}}) {
    const std::string one = name;
    EXPECT_LT(mean(rows, one + " ekf36 horizontal_error"), limit_m) << one;
    EXPECT_GT(mean(rows, one + " fixed_gain_hold horizontal_error"), 5.0 * limit_m) << one;
    EXPECT_GT(mean(rows, one + " ekf36 time_to_100m"), 80.0) << one;
    EXPECT_NEAR(mean(rows, one + " ekf36 predicted_over_actual"), 1.0, 0.35) << one;
    expect_consistent(rows, one + " ekf36 nees9", 9);
  }
  EXPECT_LT(mean(rows, "aided ekf36 horizontal_error"), 2.8);
  // Of some ninety outages.
  EXPECT_GT(mean(rows, "random ekf36 forecast_coverage"), 0.87);
}

TEST(Headline, Hydro) {
  const Rows rows = rows_of(
      "hydro --case perfect --case dvl_loss_300s --case dvl_loss_300s_coeff_30pct --case "
      "dvl_loss_300s_straight "
      "--method ins_dvl --method linked --method engine --method engine_no_model");
  EXPECT_LT(mean(rows, "dvl_loss_300s engine drift_since_loss"), 2.5);
  EXPECT_LT(mean(rows, "dvl_loss_300s_coeff_30pct engine drift_since_loss"), 3.6);
  EXPECT_LT(mean(rows, "dvl_loss_300s_straight engine drift_since_loss"), 16.0);
  EXPECT_GT(mean(rows, "dvl_loss_300s engine_no_model drift_since_loss"), 40.0);
  EXPECT_LT(mean(rows, "perfect ins_dvl position_rms_199s"), 12.0);
  EXPECT_LT(mean(rows, "perfect engine position_rms_199s"), 12.0);
  for (const char* one : {"dvl_loss_300s", "dvl_loss_300s_coeff_30pct", "dvl_loss_300s_straight"})
    expect_consistent(rows, std::string(one) + " engine nees_position", 2);
  // Told of the scale error of the DVL each in its own way, they all know how good they are.
  for (const char* one : {"ins_dvl", "linked", "engine"})
    expect_consistent(rows, std::string("perfect ") + one + " nees_position", 2);
}

// The handover of an air drop is drawn at its sigmas, its hull at 10 %.
TEST(Headline, AirDropFromDrawnHandovers) {
  const Rows rows = rows_of("scenarios --case air_drop", 50);
  EXPECT_EQ(mean(rows, "air_drop fusion aligned"), 1.0);
  expect_consistent(rows, "air_drop fusion nees_tilt", 2, 50);
  EXPECT_GT(mean(rows, "air_drop fusion coverage_95"), 0.92);
  EXPECT_GT(mean(rows, "air_drop fusion end_inside_95"), 0.9);
  EXPECT_LT(rows.at("air_drop fusion horizontal_rms").at("median").get<double>(), 45.0);
}

// The hull is drawn at 30 % and does what the estimator's model does not know of.
TEST(Headline, DvlLossWithDrawnHulls) {
  const Rows rows = rows_of("scenarios --case dvl_loss", 20);
  EXPECT_GT(mean(rows, "dvl_loss fusion coverage_95"), 0.92);
  EXPECT_GT(mean(rows, "dvl_loss fusion end_inside_95"), 0.92);
  EXPECT_LT(mean(rows, "dvl_loss fusion nees_position"), 3.0);
  EXPECT_LT(mean(rows, "dvl_loss fusion horizontal_rms"), 6.5);
}

// Each scenario of the demonstration, through device bytes and codecs, keeps the limits that it ships with.
TEST(Headline, ScenariosKeepTheirLimits) {
  const Rows rows = rows_of("scenarios");
  for (const char* name : {"survey", "air_drop", "flight", "rotating_arm", "dvl_loss"}) {
    std::ifstream file(std::string(FATHOM_SOURCE_DIR) + "/deploy/config/scenarios/" + name + ".json");
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

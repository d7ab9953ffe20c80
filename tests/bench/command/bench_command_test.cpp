#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/process.hpp"

namespace fathom::test {
namespace {

// What the command says, not how fast it was: a test that times fails on a busy machine.
TEST(BenchCommand, GivesEachFigureWithItsFloor) {
  Process bench("fathom", {"bench", "--rounds", "1", "--json"});
  ASSERT_EQ(bench.wait(), 0) << bench.err();
  const auto out = nlohmann::json::parse(bench.out());
  ASSERT_TRUE(out.at("rows").is_array());
  std::set<std::string> names;
  for (const auto& row : out.at("rows")) {
    EXPECT_EQ(row.size(), 5U);
    const auto name = row.at("name").get<std::string>();
    EXPECT_TRUE(names.insert(name).second) << name << " stands twice";
    EXPECT_FALSE(row.at("unit").get<std::string>().empty()) << name;
    for (const char* key : {"value", "floor", "ratio"}) {
      ASSERT_TRUE(row.at(key).is_number()) << name << ' ' << key;
      EXPECT_GT(row.at(key).get<double>(), 0.0) << name << ' ' << key;
    }
  }
  for (const char* name : {"predict_gps_ins15",
                           "predict_hybrid25",
                           "predict_full",
                           "update_dvl_velocity_full",
                           "update_gps_position_full",
                           "update_gps_velocity_full",
                           "update_dvl_beams_full",
                           "update_depth_full",
                           "ukf_step_printed",
                           "ukf_step_linked",
                           "model_velocity_step_full",
                           "update_heading_full",
                           "update_usbl_position_full",
                           "update_usbl_vector_full",
                           "update_usbl_range_bearing_full",
                           "update_airspeed_full",
                           "update_flow_angles_full",
                           "update_baro_altitude_full",
                           "update_speed_log_full",
                           "update_non_holonomic_full",
                           "update_constant_depth_full",
                           "update_zero_velocity_full",
                           "solve_gps_ins15",
                           "solve_standard",
                           "solve_full",
                           "late_fix_2s_full_100hz",
                           "late_fix_2s_full_100hz_steps",
                           "late_fix_2s_full_400hz"})
    EXPECT_EQ(names.count(name), 1U) << name;
}

TEST(BenchCommand, ALateFixRepeatsABoundedNumberOfSteps) {
  Process bench("fathom", {"bench", "--rounds", "1"});  // not a terminal: JSON
  ASSERT_EQ(bench.wait(), 0) << bench.err();
  const auto out = nlohmann::json::parse(bench.out());
  int found = 0;
  for (const auto& row : out.at("rows")) {
    if (row.at("unit") != "steps") continue;
    ++found;
    // The delay, and the distance between two snapshots.
    EXPECT_GE(row.at("ratio").get<double>(), 1.0) << row;
    EXPECT_LE(row.at("ratio").get<double>(), 1.11) << row;
  }
  EXPECT_EQ(found, 4);
}

}  // namespace
}  // namespace fathom::test

// Heading from GPS velocity on recorded vehicles, from an unknown one: found without help, never confidently
// wrong, and the position during GPS outages no worse for it.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dataset/dataset.hpp"
#include "support/data.hpp"
#include "support/paths.hpp"
#include "support/process.hpp"
#include "support/sanitized.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

struct Vehicle {
  const char* name;
  const char* windows;
  std::array<double, 3> drift_m;   ///< most at the end of 10, 20 and 60 s, rms of the windows
  std::array<double, 3> begins_s;  ///< recordings cut to begin there, under way
  int straight;                    ///< fixes on straights at least
};

std::string config_of(const Vehicle& vehicle) {
  return source_dir() + "/deploy/config/solve/" + vehicle.name + ".json";
}

// A car's heading is that of its wheels, which go where they point. An aircraft crabs in the wind: its course
// is compared through the air, and its heading with the reference as well.
void expect_honest(const nlohmann::json& metrics, int straight, double aligned_within_s) {
  const auto& heading = metrics["heading"];
  ASSERT_TRUE(heading["aligned_after_s"].is_number()) << "never aligned";
  EXPECT_LT(heading["aligned_after_s"].get<double>(), aligned_within_s);
  const auto& course = heading["course_made_good"];
  EXPECT_GE(course["count"].get<int>(), straight);
  EXPECT_GE(course["aligned"]["count"].get<int>(), 4 * straight / 5);
  EXPECT_EQ(course["beyond_3_sigma"], 0) << course.dump(1);
  if (course["through"] == "ground") {
    EXPECT_EQ(course["beyond_3_own_sigma"], 0) << course.dump(1);
  }
  if (!heading.contains("reference")) return;
  EXPECT_GT(heading["reference"]["count"].get<int>(), 5000);
  EXPECT_EQ(heading["reference"]["beyond_3_sigma"], 0) << heading["reference"].dump(1);
}

class RecordedHeading : public ::testing::TestWithParam<Vehicle> {
 protected:
  void SetUp() override {
    if (!fs::exists(fs::path(datasets_dir()) / GetParam().name))
      FATHOM_DATA_IS_MISSING("no data set " << GetParam().name << " in " << datasets_dir());
    std::string pattern = (fs::temp_directory_path() / "fathom-heading-XXXXXX").string();
    folder = mkdtemp(pattern.data());
  }
  void TearDown() override {
    if (!folder.empty()) fs::remove_all(folder);
  }
  nlohmann::json solve(const std::string& data, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{
        "solve",  data, "--config", config_of(GetParam()), "--out", (folder / "nav.csv").string(),
        "--rate", "1",  "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process process("fathom", arguments);
    EXPECT_EQ(process.wait(), 0) << process.err();
    return nlohmann::json::parse(process.out(), nullptr, false);
  }

  fs::path folder;
};

TEST_P(RecordedHeading, IsFoundWithoutHelpAndNeverConfidentlyWrong) {
  const Vehicle& vehicle = GetParam();
  expect_honest(solve(datasets_dir() + "/" + vehicle.name), vehicle.straight, 60.0);
}

TEST_P(RecordedHeading, FromWhereverTheRecordingIsCut) {
  if (kSanitized) GTEST_SKIP() << "sanitized: the whole recording runs through the same code";
  const Vehicle& vehicle = GetParam();
  const dataset::Dataset whole =
      dataset::read(datasets_dir() + "/" + vehicle.name, {dataset::kDefaultEpochNs, "auv"});
  for (const double begin_s : vehicle.begins_s) {
    dataset::Dataset cut = whole;
    const TimeNs begin_ns = dataset::kDefaultEpochNs + from_seconds(begin_s);
    const auto drop = [&](auto& stream) {
      std::erase_if(stream, [&](const auto& sample) { return sample.header.stamp_ns < begin_ns; });
    };
    drop(cut.of<ImuSample>());
    drop(cut.of<GpsSample>());
    drop(cut.of<AirspeedSample>());
    drop(cut.reference);
    const std::string data = (folder / std::to_string(static_cast<int>(begin_s))).string();
    dataset::write(data, cut);
    SCOPED_TRACE("cut at " + std::to_string(begin_s) + " s");
    expect_honest(solve(data), 15, 90.0);
  }
}

TEST_P(RecordedHeading, CostsNoPositionDuringOutages) {
  if (kSanitized) GTEST_SKIP() << "sanitized: the whole recording runs through the same code";
  const Vehicle& vehicle = GetParam();
  const auto metrics = solve(datasets_dir() + "/" + vehicle.name, {"--gps-outage", vehicle.windows});
  ASSERT_EQ(metrics["gps_outages"].size(), vehicle.drift_m.size());
  for (std::size_t i = 0; i < vehicle.drift_m.size(); ++i) {
    const auto& outage = metrics["gps_outages"][i];
    EXPECT_GE(outage["count"].get<int>(), 10);
    EXPECT_LE(outage["horizontal_error_m"]["rms"].get<double>(), vehicle.drift_m[i]) << outage["duration_s"];
  }
  // Without GPS the heading must not lie either; the solution is that of the first duration.
  EXPECT_EQ(metrics["heading"]["course_made_good"]["beyond_3_sigma"], 0);
}

INSTANTIATE_TEST_SUITE_P(
    Vehicles, RecordedHeading,
    ::testing::Values(Vehicle{"rtkx_drive", "10,20,60@110.2", {4.0, 13.0, 40.0}, {128.0, 247.0, 332.0}, 800},
                      Vehicle{"thor75", "10,20,60@252", {10.0, 23.0, 70.0}, {240.0, 302.0, 380.0}, 50}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace fathom::test

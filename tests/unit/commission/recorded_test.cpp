#include <algorithm>
#include <filesystem>
#include <set>

#include <gtest/gtest.h>

#include "support/data.hpp"
#include "support/paths.hpp"
#include "unit/commission/sabotage.hpp"
#include "unit/commission/vehicle.hpp"

namespace fathom::test {
namespace {

const std::filesystem::path kDatasets = datasets_dir();

struct Recorded {
  const char* folder;
  double rate_hz;
  std::set<std::string> instruments;
};

// rtkx: a car, thor75: a small aircraft, akit: an AUV, mimu: a multicopter without turns.
const std::vector<Recorded>& recorded() {
  static const std::vector<Recorded> kAll = {
      {"rtkx_drive", 100.0, {"imu", "gps"}},  {"thor75", 50.0, {"imu", "gps"}},
      {"akit/traj01", 100.0, {"imu", "dvl"}}, {"akit/traj02", 100.0, {"dvl"}},
      {"akit/traj05", 100.0, {"dvl"}},        {"akit/traj07", 100.0, {"imu", "dvl"}},
      {"akit/traj09", 100.0, {"dvl"}},        {"akit/traj12", 100.0, {"dvl"}},
      {"mimu/horizontal_3", 120.0, {"gps"}},  {"mimu/horizontal_7", 120.0, {"gps"}},
      {"mimu/horizontal_9", 120.0, {"gps"}},  {"mimu/horizontal_10", 120.0, {"gps"}},
      {"mimu/vertical_1", 120.0, {"gps"}},    {"mimu/vertical_9", 120.0, {"gps"}},
  };
  return kAll;
}

commission::Assumed assumed(const Recorded& one) {
  commission::Assumed out;
  out.configured = true;
  out.imu_rate_hz = one.rate_hz;
  return out;
}

TEST(CommissionRecorded, NamesNothingOfRecordingsAsTheyAre) {
  if (!std::filesystem::exists(kDatasets)) FATHOM_DATA_IS_MISSING(kDatasets << " is not there");
  for (const Recorded& one : recorded()) {
    const auto found = commission::commission(dataset::read(kDatasets / one.folder), assumed(one));
    EXPECT_EQ(wrongs(found.findings), "") << one.folder;
  }
}

TEST(CommissionRecorded, NamesEachSabotageThatTheLogCanTell) {
  if (!std::filesystem::exists(kDatasets)) FATHOM_DATA_IS_MISSING(kDatasets << " is not there");
  for (const Recorded& one : recorded()) {
    if (!one.instruments.contains("imu")) continue;  // one of each vehicle is enough
    const dataset::Dataset data = dataset::read(kDatasets / one.folder);
    const auto healthy = commission::commission(data, assumed(one));
    const auto* axes = find(healthy.findings, "imu", "gyro_axes");
    const bool all_gyro_axes_told =
        axes != nullptr && axes->known && axes->text.find("x, y, z") != std::string::npos;
    for (const Sabotage& sabotage : sabotages()) {
      if (!one.instruments.contains(sabotage.sensor)) continue;
      // Where the log cannot tell the sign of an axis of the gyro, it cannot tell that all three are negated.
      if (sabotage.what == "gyro_axes" && !all_gyro_axes_told) continue;
      dataset::Dataset spoilt = data;
      sabotage.commit(spoilt);
      const auto found = commission::commission(spoilt, assumed(one));
      const auto* finding = find(found.findings, sabotage.sensor, sabotage.what);
      ASSERT_NE(finding, nullptr) << one.folder << " " << sabotage.name << "\n" << wrongs(found.findings);
      EXPECT_EQ(finding->severity, commission::Severity::wrong)
          << one.folder << " " << sabotage.name << ": " << finding->text << "\n"
          << wrongs(found.findings);
      EXPECT_NE(finding->text.find(sabotage.words), std::string::npos)
          << one.folder << " " << sabotage.name << ": " << finding->text;
    }
  }
}

// What the READMEs of the sets say was found by other means.
struct Written {
  const char* folder;
  const char* sensor;
  const char* what;
  double low, high;  // its range
};

TEST(CommissionRecorded, AgreesWithWhatIsWrittenOfTheRecordings) {
  if (!std::filesystem::exists(kDatasets)) FATHOM_DATA_IS_MISSING(kDatasets << " is not there");
  const std::vector<Written> all = {
      {"thor75", "gps", "latency", 0.08, 0.15},
      {"thor75", "gps", "lever_x", 0.0, 0.25},
      {"rtkx_drive", "gps", "lever_y", -0.05, 0.06},
      {"rtkx_drive", "gps", "lever_z", 0.0, 0.07},
      {"akit/traj01", "dvl", "mounting_roll", 0.059, 0.059},
      {"akit/traj01", "dvl", "mounting_pitch", -0.066, -0.066},
      {"akit/traj01", "dvl", "mounting_yaw", -0.204, -0.204},
      {"akit/traj01", "dvl", "scale", 0.0, 0.004},
      {"akit/traj01", "dvl", "lever_x", -0.07, -0.07},
      {"akit/traj01", "dvl", "lever_y", -0.02, -0.02},
      {"akit/traj01", "dvl", "latency", -0.05, 0.07},
  };
  for (const Written& one : all) {
    const auto found = commission::commission(dataset::read(kDatasets / one.folder), {});
    const auto* finding = find(found.findings, one.sensor, one.what);
    ASSERT_NE(finding, nullptr) << one.folder << " " << one.what;
    // Known or not: to five milliseconds or centimetres few of them are.
    ASSERT_LT(finding->sigma, 0.5) << one.folder << " " << finding->text;
    EXPECT_GT(finding->value, one.low - 3.0 * finding->sigma - 0.001) << one.folder << " " << finding->text;
    EXPECT_LT(finding->value, one.high + 3.0 * finding->sigma + 0.001) << one.folder << " " << finding->text;
  }
}

}  // namespace
}  // namespace fathom::test

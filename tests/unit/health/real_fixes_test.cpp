// Fixes of real receivers that nobody spoiled: none of them may be called frozen or in disagreement.

#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "dataset/dataset.hpp"
#include "health/vehicle_health.hpp"
#include "support/data.hpp"
#include "support/paths.hpp"

namespace fathom::health {
namespace {

class RealFixes : public ::testing::TestWithParam<const char*> {};

TEST_P(RealFixes, RaiseNoAlarmOfASourceThatLies) {
  const std::filesystem::path file = std::filesystem::path(test::datasets_dir()) / GetParam() / "gps.csv.gz";
  if (!std::filesystem::exists(file)) FATHOM_DATA_IS_MISSING(file << " is not here");
  // The fixes alone: the inertial samples would take seconds to read and say nothing here.
  std::string pattern = (std::filesystem::temp_directory_path() / "fathom-fixes-XXXXXX").string();
  const std::filesystem::path folder = mkdtemp(pattern.data());
  std::filesystem::copy(file, folder / "gps.csv.gz");
  const dataset::Dataset recorded = dataset::read(folder);
  std::filesystem::remove_all(folder);
  ASSERT_GT(recorded.of<GpsSample>().size(), 100U);

  HealthConfig config;
  config.nav.expected = false;
  const TimeNs begin_ns = recorded.of<GpsSample>().front().header.stamp_ns;
  const auto at = [&](TimeNs utc_ns) { return Instant{utc_ns - begin_ns + kNsPerSecond, utc_ns}; };
  VehicleHealth health(config, at(begin_ns));
  std::set<std::string> raised;
  for (const GpsSample& sample : recorded.of<GpsSample>()) {
    const Instant now = at(sample.header.stamp_ns + 100 * kNsPerMillisecond);
    health.add(sample, now);
    health.evaluate(now);
    for (const auto& [event, alarm] : health.take_transitions()) {
      if (!alarm.alarm.view().starts_with("gps_outage")) raised.insert(alarm.alarm.str() + ": " + alarm.text);
    }
  }
  EXPECT_EQ(raised, std::set<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Vehicles, RealFixes, ::testing::Values("rtkx_drive", "thor75"));

}  // namespace
}  // namespace fathom::health

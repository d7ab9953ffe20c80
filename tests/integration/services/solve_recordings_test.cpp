// `fathom solve` over real vehicles.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sim/random.hpp"
#include "solve_fixture.hpp"
#include "support/data.hpp"
#include "support/paths.hpp"
#include "support/sanitized.hpp"

namespace fathom::test {
namespace {

class SolveRecordings : public SolveTest {
 protected:
  /// The folder of a recording; under a sanitizer, which takes many times as long, of its beginning.
  [[nodiscard]] std::string recording(const std::string& name, double enough_s) const {
    const fs::path whole = fs::path(datasets_dir()) / name;
    if (!kSanitized) return whole.string();
    dataset::Dataset data = dataset::read(whole);
    const TimeNs end_ns = data.of<ImuSample>().front().header.stamp_ns + from_seconds(enough_s);
    const auto cut = [end_ns](auto& stream) {
      std::erase_if(stream, [end_ns](const auto& sample) { return sample.header.stamp_ns > end_ns; });
    };
    for_each_kind([&](auto kind) { cut(data.of<typename decltype(kind)::Sample>()); });
    cut(data.reference);
    dataset::write(path(name), data);
    return path(name);
  }

  /// Every trajectory of the AUV ends within 0.45 % of its way, and the mean within `mean_limit`.
  void expect_auv_within(const std::string& config, const std::vector<std::string>& sets, double mean_limit) {
    double sum = 0.0;
    int count = 0;
    for (const auto& entry : fs::directory_iterator(fs::path(datasets_dir()) / "akit")) {
      if (!entry.is_directory()) continue;
      if (kSanitized && count > 0) break;  // slow, and the others run through the same code
      std::vector<std::string> arguments{
          "solve",    entry.path().string(),
          "--config", source_dir() + "/deploy/config/solve/" + config + ".json",
          "--start",  "reference",
          "--out",    path("nav.csv"),
          "--rate",   "1",
          "--json"};
      for (const std::string& set : sets) arguments.insert(arguments.end(), {"--set", set});
      Process process("fathom", arguments);
      ASSERT_EQ(process.wait(), 0) << process.err();
      const double percent =
          nlohmann::json::parse(process.out())["horizontal_error_percent"]["end"].get<double>();
      EXPECT_LT(percent, 0.45) << entry.path();
      sum += percent;
      ++count;
    }
    ASSERT_GT(count, 0);
    EXPECT_LT(sum / count, mean_limit);
  }
};

TEST_F(SolveRecordings, RealVehicleStaysWithinOnePercentOfItsReference) {
  const fs::path akit = fs::path(datasets_dir()) / "akit";
  if (!fs::exists(akit)) FATHOM_DATA_IS_MISSING("no data sets in " << datasets_dir());
  expect_auv_within("akit", {}, kSanitized ? 0.45 : 0.25);  // of one, of them all
}

// Nothing in a class comes from a recording: only where the instruments sit is told.
TEST_F(SolveRecordings, AClassOfVehiclesServesAVehicleThatItWasNotFittedTo) {
  if (!fs::exists(fs::path(datasets_dir()) / "rtkx_drive"))
    FATHOM_DATA_IS_MISSING("no data sets in " << datasets_dir());
  if (kSanitized) GTEST_SKIP() << "many runs of whole recordings; the others run through the same code";
  struct Vehicle {
    const char* recording;
    const char* kind;
    const char* start_s;
    std::array<double, 3> limits_m;
  };
  for (const Vehicle& vehicle : {Vehicle{"rtkx_drive", "mems_car", "110.2", {3.0, 9.0, 35.0}},
                                 Vehicle{"thor75", "mems_fixed_wing", "252", {8.0, 18.0, 62.0}}}) {
    Process process(
        "fathom", {"solve", recording(vehicle.recording, 0.0), "--config",
                   source_dir() + "/deploy/config/solve/" + vehicle.kind + ".json", "--out", path("nav.csv"),
                   "--rate", "1", "--gps-outage", std::string("10,20,60@") + vehicle.start_s, "--json"});
    ASSERT_EQ(process.wait(), 0) << process.err();
    const auto metrics = nlohmann::json::parse(process.out());
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& outage = metrics["gps_outages"][i];
      EXPECT_LT(outage["horizontal_error_m"]["rms"].get<double>(), vehicle.limits_m[i]) << vehicle.kind;
      EXPECT_GT(outage["forecast_coverage"].get<double>(), 0.85) << vehicle.kind;
    }
    EXPECT_LT(metrics["innovations"]["gps.gps_position"]["mean_normalised_squared"].get<double>(), 1.5);
  }
  expect_auv_within(
      "tactical_auv",
      {"engine.sensors.0.lever_B_m=[-0.07,-0.02,0.28]", "engine.output_lever_B_m=[1.779,0.013,0.115]"}, 0.25);
}

// It flies to and fro sideways, which would look as exchanged axes of the gyro to who takes it for an
// aircraft.
TEST_F(SolveRecordings, AMulticopterByItsClassIsHonestWhereGpsIsWithheld) {
  const fs::path flights = fs::path(datasets_dir()) / "mimu";
  if (!fs::exists(flights)) FATHOM_DATA_IS_MISSING("no data sets in " << datasets_dir());
  double squares = 0.0;
  double covered = 0.0;
  double windows = 0.0;
  for (const char* flight :
       {"horizontal_3", "horizontal_7", "horizontal_9", "horizontal_10", "vertical_1", "vertical_9"}) {
    Process process("fathom",
                    {"solve", (flights / flight).string(), "--config",
                     source_dir() + "/deploy/config/solve/mems_multirotor.json", "--set",
                     "engine.imu.nominal_rate_hz=120", "--set", "engine.sensors.0.lever_B_m=[0,-0.05,-0.23]",
                     "--set", "engine.output_lever_B_m=[0,-0.05,-0.23]", "--start", "reference", "--out",
                     path("nav.csv"), "--rate", "1", "--gps-outage", "10@8:12", "--json"});
    ASSERT_EQ(process.wait(), 0) << process.err();
    const auto metrics = nlohmann::json::parse(process.out());
    EXPECT_EQ(metrics["refused_to_align"], nlohmann::json::array()) << flight;
    EXPECT_LT(metrics["innovations"]["gps.gps_position"]["mean_normalised_squared"].get<double>(), 1.5)
        << flight;
    for (const auto& window : metrics["gps_outages"][0]["windows"]) {
      const double error_m = window["horizontal_error_m"].get<double>();
      squares += error_m * error_m;
      covered += error_m < window["forecast_95_m"].get<double>() ? 1.0 : 0.0;
      windows += 1.0;
    }
  }
  ASSERT_GE(windows, 10.0);
  EXPECT_LT(std::sqrt(squares / windows), 6.0);
  EXPECT_GT(covered / windows, 0.9);
}

// Its course is no heading, and nothing tells one: how its velocity changes does. The log of these flights
// has no velocities of the receiver, so they are those of its reference with the noise of a Doppler velocity.
TEST_F(SolveRecordings, AMulticopterWithoutACompassFindsItsHeadingInFlight) {
  const fs::path flights = fs::path(datasets_dir()) / "mimu";
  if (!fs::exists(flights)) FATHOM_DATA_IS_MISSING("no data sets in " << datasets_dir());
  int aligned = 0;
  for (const char* flight : {"horizontal_3", "horizontal_7", "horizontal_9", "horizontal_10"}) {
    dataset::Dataset data = dataset::read(flights / flight);
    sim::Random random(1, flight);
    for (GpsSample& fix : data.of<GpsSample>()) {
      const auto at = std::lower_bound(
          data.reference.begin(), data.reference.end(), fix.header.stamp_ns,
          [](const Truth& truth, TimeNs stamp_ns) { return truth.header.stamp_ns < stamp_ns; });
      if (at == data.reference.end()) continue;
      fix.velocity_N_m_s = at->velocity_N_m_s;
      for (double& one : fix.velocity_N_m_s) one += random.normal(0.05);
    }
    dataset::write(path(flight), data);
    Process process(
        "fathom",
        {"solve", path(flight), "--config", source_dir() + "/deploy/config/solve/mems_multirotor.json",
         "--set", "engine.imu.nominal_rate_hz=120", "--set", "engine.sensors.0.lever_B_m=[0,-0.05,-0.23]",
         "--set", "engine.output_lever_B_m=[0,-0.05,-0.23]", "--out", path("nav.csv"), "--json"});
    ASSERT_EQ(process.wait(), 0) << process.err();
    const auto metrics = nlohmann::json::parse(process.out());
    EXPECT_EQ(metrics["refused_to_align"], nlohmann::json::array()) << flight;
    if (metrics["ever_aligned"].get<bool>()) ++aligned;
    const double navigating = metrics["positions"].get<double>() / metrics["imu_samples"].get<double>();
    EXPECT_GT(navigating, 0.9) << flight;  // of 46 to 54 s
    // The yaw of the reference is itself one to two degrees off.
    EXPECT_LT(metrics["attitude_error_deg"]["yaw"]["rms"].get<double>(), 5.0) << flight;
    EXPECT_LT(metrics["horizontal_error_m"]["rms"].get<double>(), 0.2) << flight;
  }
  EXPECT_GE(aligned, 3);  // within less than a minute
}

// The fixes of these recordings are stamped some hundredths of a second off their instant, and the reference
// is made of them: only withheld fixes, each at its own instant, tell which of the two is better.
TEST_F(SolveRecordings, SmoothedRealVehiclesAreNearerToTheFixesTheyWereNotGiven) {
  if (!fs::exists(fs::path(datasets_dir()) / "rtkx_drive"))
    FATHOM_DATA_IS_MISSING("no data sets in " << datasets_dir());
  struct Vehicle {
    const char* name;
    const char* windows;
    double given_m;   ///< smoothed, at the fixes it was given, rms
    double enough_s;  ///< of the recording, for one withheld window
  };
  for (const Vehicle& vehicle :
       {Vehicle{"rtkx_drive", "20@110.2", 0.15, 170.0}, Vehicle{"thor75", "20@252", 1.4, 310.0}}) {
    const std::string config = source_dir() + "/deploy/config/solve/" + vehicle.name + ".json";
    Process process("fathom",
                    {"solve", recording(vehicle.name, vehicle.enough_s), "--config", config, "--out",
                     path("nav.csv"), "--rate", "1", "--smooth", "--gps-outage", vehicle.windows, "--json"});
    ASSERT_EQ(process.wait(), 0) << process.err();
    const auto metrics = nlohmann::json::parse(process.out());
    const auto& outage = metrics["gps_outages"][0];
    EXPECT_LT(outage["smoothed_inside_horizontal_error_m"]["rms"].get<double>(),
              0.5 * outage["inside_horizontal_error_m"]["rms"].get<double>())
        << vehicle.name;
    // A part of a recording knows less of the vehicle than the whole.
    const double given_m = kSanitized ? 2.0 * vehicle.given_m : vehicle.given_m;
    EXPECT_LT(metrics["at_fixes"]["horizontal_error_m"]["rms"].get<double>(), given_m) << vehicle.name;
  }
}

}  // namespace
}  // namespace fathom::test

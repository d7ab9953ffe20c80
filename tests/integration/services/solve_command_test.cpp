#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dataset/dataset.hpp"
#include "support/process.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

constexpr double kEarthRate = 7.292115e-5;
constexpr double kLatitude = 0.6;

/// A vehicle on a straight course to the north at constant depth and speed, written as a data set. Its
/// inertial unit feels gravity, the Earth's rotation, the turn of the local level and the Coriolis force.
class StraightCourse {
 public:
  static constexpr double kSpeed_m_s = 2.0;
  static constexpr int kSeconds = 60;

  explicit StraightCourse(bool with_gps) {
    constexpr double kMeridian_m = 6'355'776.3;  // radius of curvature at this latitude
    const double gravity = 9.780325 * (1.0 + 0.00193185 * std::pow(std::sin(kLatitude), 2)) /
                           std::sqrt(1.0 - 0.00669438 * std::pow(std::sin(kLatitude), 2));
    for (int i = 0; i <= kSeconds * 100; ++i) {
      const TimeNs stamp = dataset::kDefaultEpochNs + i * 10'000'000LL;
      const double latitude = kLatitude + kSpeed_m_s * 0.01 * i / kMeridian_m;
      ImuSample& imu = data.imu.emplace_back();
      imu.header.stamp_ns = imu.header.received_ns = stamp;
      imu.angular_rate_B_rad_s = {kEarthRate * std::cos(latitude), -kSpeed_m_s / kMeridian_m,
                                  -kEarthRate * std::sin(latitude)};
      imu.specific_force_B_m_s2 = {0.0, 2.0 * kEarthRate * std::sin(latitude) * kSpeed_m_s,
                                   -gravity - kSpeed_m_s * kSpeed_m_s / kMeridian_m};
      if (i % 10 == 0) {
        Truth& truth = data.reference.emplace_back();
        truth.header = imu.header;
        truth.latitude_rad = latitude;
        truth.longitude_rad = 0.3;
        truth.altitude_m = 0.0;
        truth.velocity_N_m_s = {kSpeed_m_s, 0.0, 0.0};
        truth.rpy_rad = {0.0, 0.0, 0.0};
      }
      if (i % 100 == 3) {
        DvlSample& dvl = data.dvl.emplace_back();
        dvl.header.stamp_ns = stamp;
        dvl.header.received_ns = stamp + 200'000'000;
        dvl.velocity_D_m_s = {kSpeed_m_s, 0.0, 0.0};
      }
      if (with_gps && i % 50 == 0) {
        GpsSample& gps = data.gps.emplace_back();
        gps.header = imu.header;
        gps.fix = GpsFix::fix_3d;
        gps.latitude_rad = latitude;
        gps.longitude_rad = 0.3;
        gps.altitude_m = 0.0;
        gps.position_sigma_N_m = {1.0, 1.0, 2.0};
        gps.velocity_N_m_s = {kSpeed_m_s, 0.0, 0.0};
      }
    }
  }

  dataset::Dataset data;
};

/// A folder for a data set, a configuration and what solve makes of them.
class SolveTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "fathom-solve-XXXXXX").string();
    folder = mkdtemp(pattern.data());
    write("config.json",
          R"({"start": {"mode": "automatic"}, "engine": {"configuration": "gps_ins15", "imu": {},
      "sensors": [
        {"sensor": "gps0", "kind": "gps", "lever_B_m": [0, 0, 0]},
        {"sensor": "dvl0", "kind": "dvl", "lever_B_m": [0, 0, 0], "mounting_rpy_deg": [0, 0, 0]}]}})");
  }
  void TearDown() override { fs::remove_all(folder); }

  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder / name).string(); }
  [[nodiscard]] std::string content(const std::string& name) const {
    std::ifstream file(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  // Runs `fathom solve data --config config.json --out nav.csv` and more; the exit code.
  int solve(std::vector<std::string> more, const std::string& config = "config.json") {
    std::vector<std::string> arguments{"solve",      path("data"), "--config",
                                       path(config), "--out",      path("nav.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Process process("fathom", arguments);
    const int code = process.wait();
    out = process.out();
    err = process.err();
    return code;
  }

  fs::path folder;
  std::string out;
  std::string err;
};

TEST_F(SolveTest, FollowsTheReferenceFromItsStart) {
  dataset::write(path("data"), StraightCourse(false).data);
  ASSERT_EQ(solve({"--start", "reference", "--metrics", path("m.json")}), 0) << err;
  EXPECT_EQ(err, "");
  const auto metrics = nlohmann::json::parse(content("m.json"));
  EXPECT_EQ(metrics["imu_samples"], 6001);
  EXPECT_EQ(metrics["start"], "reference");
  EXPECT_EQ(metrics["verdicts"]["dvl"]["used"], 60);
  EXPECT_NEAR(metrics["distance_m"].get<double>(), 120.0, 0.5);
  EXPECT_LT(metrics["horizontal_error_m"]["end"].get<double>(), 0.1);
  EXPECT_LT(metrics["horizontal_error_percent"]["end"].get<double>(), 0.1);
  EXPECT_LT(metrics["attitude_error_deg"]["yaw"]["max"].get<double>(), 0.1);
  EXPECT_LT(metrics["nees"]["horizontal"]["mean"].get<double>(), 7.4);
  EXPECT_GT(metrics["time_per_imu_sample_us"].get<double>(), 0.0);

  std::istringstream nav(content("nav.csv"));
  std::string line;
  std::getline(nav, line);
  EXPECT_EQ(line.substr(0, 75),
            "t_s,lat_deg,lon_deg,alt_m,vn_m_s,ve_m_s,vd_m_s,roll_deg,pitch_deg,yaw_deg,s");
  int rows = 0;
  std::string last;
  while (std::getline(nav, line)) {
    ++rows;
    last = line;
  }
  EXPECT_EQ(rows, 6001);
  EXPECT_EQ(last.substr(0, 6), "60.00,");
  EXPECT_NE(last.find(",dead_reckoning,,"), std::string::npos) << last;
}

TEST_F(SolveTest, WritesTheSameBytesTwiceAndFewerRowsWhereAsked) {
  dataset::write(path("data"), StraightCourse(false).data);
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
  const std::string first = content("nav.csv");
  ASSERT_EQ(solve({"--start", "reference"}), 0) << err;
  EXPECT_EQ(first, content("nav.csv"));
  ASSERT_EQ(solve({"--start", "reference", "--rate", "10"}), 0) << err;
  const std::string thin = content("nav.csv");
  EXPECT_EQ(std::count(thin.begin(), thin.end(), '\n'), 1 + 601);
}

TEST_F(SolveTest, ComparesOutagesWithTheRemovedFixes) {
  dataset::write(path("data"), StraightCourse(true).data);
  ASSERT_EQ(solve({"--start", "reference", "--gps-outage", "4,8@5:6", "--json"}), 0) << err;
  const auto metrics = nlohmann::json::parse(out);
  ASSERT_EQ(metrics["gps_outages"].size(), 2U);
  const auto& four = metrics["gps_outages"][0];
  EXPECT_EQ(four["duration_s"], 4.0);
  // 4 s every 10 s until 60 s, from 5, 18, 31 and 44 s.
  EXPECT_EQ(four["count"], 6 + 4 + 3 + 2);
  EXPECT_NEAR(four["windows"][0]["start_s"].get<double>(), 5.0, 1e-9);
  EXPECT_NEAR(four["windows"][0]["end_s"].get<double>(), 8.5, 1e-9);
  EXPECT_LT(four["horizontal_error_m"]["max"].get<double>(), 0.5);
  EXPECT_GT(four["windows"][0]["predicted_95_m"].get<double>(), 0.0);
  // The passage itself lacks the six windows of 4 s from 5 s on, with eight fixes each. The
  // fix at the very end waits for an inertial sample that does not come.
  const auto& gps = metrics["verdicts"]["gps"];
  std::uint64_t judged = 0;
  for (const auto& [kind, count] : gps.items()) judged += count.get<std::uint64_t>();
  EXPECT_EQ(judged, 121U - 6U * 8U - 1U);
}

struct BadCall {
  const char* name;
  std::vector<std::string> more;
  const char* message;
};

class BadSolveCall : public SolveTest, public ::testing::WithParamInterface<BadCall> {};

TEST_P(BadSolveCall, EndsWithTwo) {
  dataset::write(path("data"), StraightCourse(true).data);
  EXPECT_EQ(solve(GetParam().more), 2);
  EXPECT_NE(err.find(GetParam().message), std::string::npos) << err;
  EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadSolveCall,
    ::testing::Values(
        BadCall{"smooth", {"--smooth"}, "fathom: --smooth: the smoother is not available in this version"},
        BadCall{"outage_text", {"--gps-outage", "ten"}, "fathom: --gps-outage: is 'ten', expected T1,T2"},
        BadCall{"outage_zero", {"--gps-outage", "0"}, "fathom: --gps-outage: is '0'"},
        BadCall{"outage_tail", {"--gps-outage", "10@5:x"}, "fathom: --gps-outage: is '10@5:x'"},
        BadCall{"start", {"--start", "somewhere"}, "--start"},
        BadCall{"set", {"--set", "engine.horizon_s=-1"}, "config.json: engine.horizon_s: is -1, expected"},
        BadCall{"unknown", {"--faster"}, "--faster"}),
    [](const auto& info) { return info.param.name; });

TEST_F(SolveTest, BadDataEndWithThreeAndNameFileAndLine) {
  dataset::Dataset data = StraightCourse(false).data;
  dataset::write(path("data"), data);
  write("data/dvl.csv", "t_s,vx_m_s,vy_m_s,vz_m_s\n1,2,0,0\n2,fast,0,0\n");
  EXPECT_EQ(solve({}), 3);
  EXPECT_NE(err.find("fathom: " + path("data") + "/dvl.csv:3: column vx_m_s: 'fast' is not a number"),
            std::string::npos)
      << err;
  fs::remove(path("data") + "/dvl.csv");
  fs::remove(path("data") + "/imu.csv");
  EXPECT_EQ(solve({}), 3);
  EXPECT_NE(err.find("imu.csv: no inertial samples"), std::string::npos) << err;
  fs::remove_all(path("data"));
  EXPECT_EQ(solve({}), 3);
  EXPECT_NE(err.find("data: is not a folder"), std::string::npos) << err;
}

TEST_F(SolveTest, AReferenceWithoutAttitudeIsNoStart) {
  dataset::Dataset data = StraightCourse(false).data;
  for (Truth& truth : data.reference) truth.rpy_rad[2] = kUnknown;
  dataset::write(path("data"), data);
  EXPECT_EQ(solve({"--start", "reference"}), 3);
  EXPECT_NE(err.find("reference.csv: the first row"), std::string::npos) << err;
}

TEST_F(SolveTest, BadMeasurementsGetVerdictsAndMoveNothing) {
  dataset::Dataset data = StraightCourse(false).data;
  data.imu[1000].angular_rate_B_rad_s[2] = kUnknown;
  data.imu[2001].header.stamp_ns = data.imu[2000].header.stamp_ns;
  data.imu[2001].header.received_ns = data.imu[2000].header.stamp_ns;
  data.dvl[10].velocity_D_m_s.fill(kUnknown);
  dataset::write(path("data"), data);
  ASSERT_EQ(solve({"--start", "reference", "--json"}), 0) << err;
  const auto metrics = nlohmann::json::parse(out);
  EXPECT_EQ(metrics["verdicts"]["imu"]["out_of_range"], 1);
  EXPECT_EQ(metrics["verdicts"]["imu"]["duplicate"], 1);
  EXPECT_EQ(metrics["verdicts"]["dvl"]["out_of_range"], 1);
  EXPECT_LT(metrics["horizontal_error_m"]["end"].get<double>(), 0.1);
}

TEST_F(SolveTest, RealVehicleStaysWithinOnePercentOfItsReference) {
  const fs::path akit = fs::path(FATHOM_DATASETS) / "akit";
  if (!fs::exists(akit)) GTEST_SKIP() << "no data sets in " << FATHOM_DATASETS;
  double sum = 0.0;
  int count = 0;
  for (const auto& entry : fs::directory_iterator(akit)) {
    if (!entry.is_directory()) continue;
    Process process("fathom", {"solve", entry.path().string(), "--config",
                               std::string(FATHOM_SOURCE_DIR) + "/deploy/config/solve/akit.json", "--start",
                               "reference", "--out", path("nav.csv"), "--rate", "1", "--json"});
    ASSERT_EQ(process.wait(), 0) << process.err();
    const double percent =
        nlohmann::json::parse(process.out())["horizontal_error_percent"]["end"].get<double>();
    EXPECT_LT(percent, 0.45) << entry.path();
    sum += percent;
    ++count;
  }
  ASSERT_GT(count, 0);
  EXPECT_LT(sum / count, 0.25);
}

}  // namespace
}  // namespace fathom::test

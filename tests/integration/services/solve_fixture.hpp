#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dataset/dataset.hpp"
#include "support/process.hpp"

namespace fathom::test {

namespace fs = std::filesystem;

inline constexpr double kEarthRate = 7.292115e-5;
inline constexpr double kSolvedLatitude_rad = 0.6;

/// A vehicle on a straight course to the north at constant depth and speed, written as a data set. Its
/// inertial unit feels gravity, the Earth's rotation, the turn of the local level and the Coriolis force.
class StraightCourse {
 public:
  static constexpr double kSpeed_m_s = 2.0;
  static constexpr int kSeconds = 60;

  explicit StraightCourse(bool with_gps) {
    constexpr double kMeridian_m = 6'355'776.3;  // radius of curvature at this latitude
    const double gravity = 9.780325 * (1.0 + 0.00193185 * std::pow(std::sin(kSolvedLatitude_rad), 2)) /
                           std::sqrt(1.0 - 0.00669438 * std::pow(std::sin(kSolvedLatitude_rad), 2));
    for (int i = 0; i <= kSeconds * 100; ++i) {
      const TimeNs stamp = dataset::kDefaultEpochNs + i * 10'000'000LL;
      const double latitude = kSolvedLatitude_rad + kSpeed_m_s * 0.01 * i / kMeridian_m;
      ImuSample& imu = data.of<ImuSample>().emplace_back();
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
        DvlSample& dvl = data.of<DvlSample>().emplace_back();
        dvl.header.stamp_ns = stamp;
        dvl.header.received_ns = stamp + 200'000'000;
        dvl.velocity_D_m_s = {kSpeed_m_s, 0.0, 0.0};
      }
      if (with_gps && i % 50 == 0) {
        GpsSample& gps = data.of<GpsSample>().emplace_back();
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
  // Runs a program to its end; the exit code.
  int run(const std::string& program, const std::vector<std::string>& arguments) {
    Process process(program, arguments);
    const int code = process.wait();
    out = process.out();
    err = process.err();
    return code;
  }
  // Runs `fathom solve data --config config.json --out nav.csv` and more; the exit code.
  int solve(std::vector<std::string> more, const std::string& config = "config.json") {
    std::vector<std::string> arguments{"solve",      path("data"), "--config",
                                       path(config), "--out",      path("nav.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run("fathom", arguments);
  }

  fs::path folder;
  std::string out;
  std::string err;
};

}  // namespace fathom::test

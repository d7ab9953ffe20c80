#include "config/fusion/mounting_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <vector>

#include "base/disk/folder.hpp"
#include "config/bridge/bridge_config.hpp"
#include "config/service_config.hpp"
#include "samples/kinds.hpp"

namespace fathom::config {
namespace {

namespace fs = std::filesystem;

bool is_identity(const std::array<double, 9>& rotation) {
  constexpr double kTolerance = 1e-9;
  for (std::size_t i = 0; i < rotation.size(); ++i) {
    if (std::abs(rotation[i] - (i % 4 == 0 ? 1.0 : 0.0)) > kTolerance) return false;
  }
  return true;
}

bool turns(const std::array<double, 3>& rpy_rad) {
  MountingConfig mounting;
  mounting.rpy_rad = rpy_rad;
  return !is_identity(mounting.rotation());
}

std::string in_degrees(const std::array<double, 3>& rpy_rad) {
  std::ostringstream out;
  for (std::size_t i = 0; i < rpy_rad.size(); ++i)
    out << (i == 0 ? "[" : ", ") << rpy_rad[i] * 180.0 / std::numbers::pi;
  out << "]";
  return out.str();
}

// One place of a mounting in fusion's file.
struct Mounting {
  std::string key;
  std::array<double, 3> rpy_rad;
};

[[noreturn]] void refuse(const std::string& file, const Mounting& mounting, const fs::path& bridge_file,
                         const std::string& bridge_key) {
  throw ConfigError(file, mounting.key, in_degrees(mounting.rpy_rad),
                    "[0, 0, 0] because " + bridge_key + " of " + bridge_file.string() +
                        " turns the same instrument, or that one to turn nothing");
}

// The configurations of bridges of this kind in a folder, in the order of their names.
template <class Bridge, class Sample, class Look>
void for_each_bridge(const fs::path& folder, Look look) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const fs::path& file : paths_in(folder, none)) {
    if (file.extension() == ".json" && file.stem().string().starts_with(KindOf<Sample>::kRole))
      files.push_back(file);
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    Bridge bridge;
    try {
      bridge = load_service_config<Bridge>({file.string(), {}}).value;
    } catch (const ConfigError&) {
      continue;
    }
    for (std::size_t i = 0; i < bridge.sensors.size(); ++i)
      look(file, "sensors." + std::to_string(i) + ".", bridge.sensors[i]);
  }
}

}  // namespace

void refuse_second_mounting(const FusionConfig& fusion, const std::string& fusion_file) {
  const fs::path folder = fs::absolute(fusion_file).parent_path();
  const Mounting imu{"engine.imu.mounting_rpy_deg", fusion.engine.imu.mounting_rpy_rad};
  if (turns(imu.rpy_rad)) {
    for_each_bridge<ImuBridgeConfig, ImuSample>(
        folder, [&](const fs::path& file, const std::string& at, const ImuSensorConfig& unit) {
          if (unit.sensor.name.str() == fusion.imu_sensor && !is_identity(unit.mounting.rotation()))
            refuse(fusion_file, imu, file, at + "mounting");
        });
  }
  for (std::size_t i = 0; i < fusion.engine.sensors.size(); ++i) {
    const estimation::SensorConfig& log = fusion.engine.sensors[i];
    if (log.kind != SourceKind::dvl || !turns(log.mounting_rpy_rad)) continue;
    const Mounting mounting{"engine.sensors." + std::to_string(i) + ".mounting_rpy_deg",
                            log.mounting_rpy_rad};
    for_each_bridge<DvlBridgeConfig, DvlSample>(
        folder, [&](const fs::path& file, const std::string& at, const DvlSensorConfig& unit) {
          if (unit.sensor.name.str() == log.sensor && turns({0.0, 0.0, unit.heading_alignment_rad}))
            refuse(fusion_file, mounting, file, at + "heading_alignment_deg");
        });
  }
}

}  // namespace fathom::config

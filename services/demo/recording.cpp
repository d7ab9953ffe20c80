#include "demo/recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "dataset/dataset.hpp"

namespace fathom::demo {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

template <class Sample>
double mean_rate_hz(const std::vector<Sample>& stream) {
  const double span_s = to_seconds(stream.back().header.stamp_ns - stream.front().header.stamp_ns);
  return stream.size() > 1 && span_s > 0.0 ? static_cast<double>(stream.size() - 1) / span_s : 1.0;
}

std::filesystem::path find_fusion_file(const std::filesystem::path& directory,
                                       const std::filesystem::path& config) {
  for (auto folder = std::filesystem::absolute(directory).lexically_normal(); folder.has_relative_path();
       folder = folder.parent_path()) {
    const auto file = config / "solve" / (folder.filename().string() + ".json");
    if (!folder.filename().empty() && std::filesystem::exists(file)) return file;
  }
  return config / "fusion.json";
}

}  // namespace

double Recording::rate_hz(const std::string& kind, double otherwise) const {
  const auto at = rates.find(kind);
  return at == rates.end() ? otherwise : at->second;
}

Recording describe_recording(const std::filesystem::path& directory, const std::filesystem::path& fusion_file,
                             const std::filesystem::path& config_directory) {
  const dataset::Dataset data = dataset::read(directory, {0, "auv"});
  if (data.imu.empty())
    throw dataset::DatasetError(directory.string() + ": no inertial samples, expected imu.csv");
  Recording out;
  out.fusion_file = fusion_file.empty() ? find_fusion_file(directory, config_directory) : fusion_file;
  const auto note = [&out](const char* kind, const auto& stream) {
    if (stream.empty()) return;
    out.bridges.emplace_back(kind);
    out.rates[kind] = mean_rate_hz(stream);
  };
  note("imu", data.imu);
  note("gps", data.gps);
  note("dvl", data.dvl);
  note("depth", data.depth);
  note("heading", data.heading);
  note("usbl", data.usbl);
  note("actuator", data.propulsion);
  out.imu_rate_hz = std::round(out.rates["imu"]);
  const TimeNs first_ns = data.imu.front().header.stamp_ns;
  const auto start = std::find_if(data.reference.begin(), data.reference.end(), [first_ns](const Truth& row) {
    return row.header.stamp_ns >= first_ns && known(row.latitude_rad) && known(row.rpy_rad[2]);
  });
  if (start == data.reference.end()) {
    throw dataset::DatasetError(
        directory.string() +
        ": no reference to start from, expected reference.csv with position and attitude");
  }
  out.start = *start;
  out.start_s = to_seconds(start->header.stamp_ns);
  out.last_imu_s = to_seconds(data.imu.back().header.stamp_ns);
  out.duration_s = out.last_imu_s + 1.0;
  return out;
}

std::vector<std::string> start_sets(const Recording& recording, TimeNs epoch_ns) {
  const Truth& at = recording.start;
  const nlohmann::json state = {
      {"stamp_ns", epoch_ns + at.header.stamp_ns},
      {"latitude_deg", at.latitude_rad * kDegrees},
      {"longitude_deg", at.longitude_rad * kDegrees},
      {"altitude_m", at.altitude_m},
      {"velocity_N_m_s", at.velocity_N_m_s},
      {"rpy_deg", {at.rpy_rad[0] * kDegrees, at.rpy_rad[1] * kDegrees, at.rpy_rad[2] * kDegrees}}};
  return {"start.mode=given", "start.state=" + state.dump()};
}

}  // namespace fathom::demo

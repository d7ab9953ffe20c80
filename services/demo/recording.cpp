#include "demo/recording.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/units.hpp"
#include "dataset/dataset.hpp"

namespace fathom::demo {
namespace {

template <class Sample>
double mean_rate_hz(const std::vector<Sample>& stream) {
  const double span_s = to_seconds(stream.back().header.stamp_ns - stream.front().header.stamp_ns);
  return stream.size() > 1 && span_s > 0.0 ? static_cast<double>(stream.size() - 1) / span_s : 1.0;
}

std::filesystem::path find_fusion_file(const std::filesystem::path& directory,
                                       const std::filesystem::path& config) {
  for (auto folder = std::filesystem::absolute(directory).lexically_normal(); folder.has_relative_path();
       folder = folder.parent_path()) {
    auto file = config / "solve" / (folder.filename().string() + ".json");
    if (!folder.filename().empty() && std::filesystem::exists(file)) return file;
  }
  return config / "fusion.json";
}

}  // namespace

double Recording::rate_hz(std::string_view kind, double otherwise) const {
  const auto at = rates.find(kind);
  return at == rates.end() ? otherwise : at->second;
}

Recording describe_recording(const std::filesystem::path& directory, const std::filesystem::path& fusion_file,
                             const std::filesystem::path& config_directory) {
  const dataset::Dataset data = dataset::read(directory, {0, "auv"});
  if (data.of<ImuSample>().empty())
    throw dataset::DatasetError(directory.string() + ": no inertial samples, expected imu.csv");
  Recording out;
  out.fusion_file = fusion_file.empty() ? find_fusion_file(directory, config_directory) : fusion_file;
  for_each_kind([&](auto kind) {
    const auto& stream = data.of<typename decltype(kind)::Sample>();
    if (stream.empty()) return;
    out.rates.emplace(kind.kWord, mean_rate_hz(stream));
    const std::string bridge(kind.kRole.substr(0, kind.kRole.rfind("_bridge")));
    if (std::find(out.bridges.begin(), out.bridges.end(), bridge) == out.bridges.end())
      out.bridges.push_back(bridge);
  });
  out.imu_rate_hz = std::round(out.rates["imu"]);
  const TimeNs first_ns = data.of<ImuSample>().front().header.stamp_ns;
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
  out.last_imu_s = to_seconds(data.of<ImuSample>().back().header.stamp_ns);
  out.duration_s = out.last_imu_s + 1.0;
  return out;
}

std::vector<std::string> start_sets(const Recording& recording, TimeNs epoch_ns) {
  const Truth& at = recording.start;
  const nlohmann::json state = {
      {"stamp_ns", epoch_ns + at.header.stamp_ns},
      {"latitude_deg", at.latitude_rad * kDegPerRad},
      {"longitude_deg", at.longitude_rad * kDegPerRad},
      {"altitude_m", at.altitude_m},
      {"velocity_N_m_s", at.velocity_N_m_s},
      {"rpy_deg", {at.rpy_rad[0] * kDegPerRad, at.rpy_rad[1] * kDegPerRad, at.rpy_rad[2] * kDegPerRad}}};
  return {"start.mode=given", "start.state=" + state.dump()};
}

}  // namespace fathom::demo

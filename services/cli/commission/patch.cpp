#include "cli/commission/patch.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string_view>

#include "base/units.hpp"
#include "geo/so3.hpp"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) {
  return std::round(value / step) * step + 0.0;
}

// Decimals as a person would write them.
Json decimal(double value, int digits) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, rounded(value, std::pow(10.0, -digits)));
  return Json::parse(text.data());
}

Json list(const Eigen::Vector3d& v, int digits) {
  return Json::array({decimal(v.x(), digits), decimal(v.y(), digits), decimal(v.z(), digits)});
}

Json rpy_deg(const Eigen::Matrix3d& C) {
  return list(geo::to_rpy(geo::from_matrix(C)) * kDegPerRad, 3);
}

Json::json_pointer pointer_of(std::string key) {
  for (char& c : key)
    if (c == '.') c = '/';
  return Json::json_pointer("/" + key);
}

}  // namespace

std::vector<Change> changes_of(const commission::Patch& patch, const Json& config) {
  std::vector<Change> out;
  const auto change = [&](const std::string& key, Json value) {
    const auto pointer = pointer_of(key);
    out.push_back({key, config.contains(pointer) ? config.at(pointer) : Json(nullptr), std::move(value)});
  };
  const auto sensor = [&](std::string_view kind) -> std::optional<std::string> {
    const auto pointer = pointer_of("engine.sensors");
    if (!config.contains(pointer)) return std::nullopt;
    const Json& sensors = config.at(pointer);
    for (std::size_t i = 0; i < sensors.size(); ++i)
      if (sensors[i].value("kind", "") == kind) return "engine.sensors." + std::to_string(i) + ".";
    return std::nullopt;
  };
  if (patch.imu_rate_hz) change("engine.imu.nominal_rate_hz", decimal(*patch.imu_rate_hz, 1));
  if (patch.C_BI) change("engine.imu.mounting_rpy_deg", rpy_deg(*patch.C_BI));
  if (patch.angle_random_walk)
    change("engine.imu.angle_random_walk_deg_sqrt_h",
           decimal(*patch.angle_random_walk * 60.0 * 180.0 / std::numbers::pi, 4));
  if (patch.velocity_random_walk)
    change("engine.imu.velocity_random_walk_m_s_sqrt_h", decimal(*patch.velocity_random_walk * 60.0, 4));
  if (const auto gps = sensor("gps")) {
    if (patch.gps_lever_B_m) change(*gps + "lever_B_m", list(*patch.gps_lever_B_m, 3));
    if (patch.gps_latency_s) change(*gps + "latency_s", decimal(*patch.gps_latency_s, 4));
  }
  if (const auto dvl = sensor("dvl")) {
    if (patch.C_BD) change(*dvl + "mounting_rpy_deg", rpy_deg(*patch.C_BD));
    if (patch.dvl_lever_B_m) change(*dvl + "lever_B_m", list(*patch.dvl_lever_B_m, 3));
    if (patch.dvl_latency_s) change(*dvl + "latency_s", decimal(*patch.dvl_latency_s, 4));
  }
  const auto depth = sensor("depth");
  if (depth && patch.depth_latency_s) change(*depth + "latency_s", decimal(*patch.depth_latency_s, 4));
  const auto heading = sensor("heading");
  if (heading && patch.heading_latency_s)
    change(*heading + "latency_s", decimal(*patch.heading_latency_s, 4));
  if (heading && patch.heading_yaw_rad)
    change(*heading + "mounting_rpy_deg", list({0.0, 0.0, *patch.heading_yaw_rad * kDegPerRad}, 3));
  return out;
}

std::vector<Change> vehicle_changes_of(const commission::Patch& patch, const Json& vehicle) {
  std::vector<Change> out;
  const Json& instruments = vehicle.at("instruments");
  const auto first = [&](std::string_view kind) -> std::optional<std::string> {
    for (std::size_t i = 0; i < instruments.size(); ++i) {
      if (instruments[i].at("kind") == kind && instruments[i].value("enabled", true))
        return "instruments." + std::to_string(i) + ".";
    }
    return std::nullopt;
  };
  const auto change = [&](const std::optional<std::string>& instrument, const std::string& key, Json value) {
    if (!instrument) return;
    const auto pointer = pointer_of(*instrument + key);
    out.push_back({*instrument + key, vehicle.contains(pointer) ? vehicle.at(pointer) : Json(nullptr),
                   std::move(value)});
  };
  const auto imu = first("imu");
  Eigen::Vector3d unit_m = Eigen::Vector3d::Zero();
  if (const auto at = pointer_of(imu.value_or("instruments.0.") + "position_m"); vehicle.contains(at)) {
    for (int i = 0; i < 3; ++i) unit_m[i] = vehicle.at(at).at(static_cast<std::size_t>(i)).get<double>();
  }
  if (patch.imu_rate_hz) change(imu, "rate_hz", decimal(*patch.imu_rate_hz, 1));
  if (patch.C_BI) change(imu, "mounting_rpy_deg", rpy_deg(*patch.C_BI));
  if (patch.angle_random_walk)
    change(imu, "fusion.angle_random_walk_deg_sqrt_h",
           decimal(*patch.angle_random_walk * 60.0 * 180.0 / std::numbers::pi, 4));
  if (patch.velocity_random_walk)
    change(imu, "fusion.velocity_random_walk_m_s_sqrt_h", decimal(*patch.velocity_random_walk * 60.0, 4));
  const auto gps = first("gps");
  if (patch.gps_lever_B_m) change(gps, "position_m", list(*patch.gps_lever_B_m + unit_m, 3));
  if (patch.gps_latency_s) change(gps, "fusion.latency_s", decimal(*patch.gps_latency_s, 4));
  const auto dvl = first("dvl");
  if (patch.C_BD) change(dvl, "mounting_rpy_deg", rpy_deg(*patch.C_BD));
  if (patch.dvl_lever_B_m) change(dvl, "position_m", list(*patch.dvl_lever_B_m + unit_m, 3));
  if (patch.dvl_latency_s) change(dvl, "fusion.latency_s", decimal(*patch.dvl_latency_s, 4));
  if (patch.depth_latency_s) change(first("depth"), "fusion.latency_s", decimal(*patch.depth_latency_s, 4));
  if (patch.heading_latency_s)
    change(first("heading"), "fusion.latency_s", decimal(*patch.heading_latency_s, 4));
  if (patch.heading_yaw_rad)
    change(first("heading"), "mounting_rpy_deg", list({0.0, 0.0, *patch.heading_yaw_rad * kDegPerRad}, 3));
  return out;
}

Json patched(Json config, const std::vector<Change>& changes) {
  for (const Change& change : changes) config[pointer_of(change.key)] = change.value;
  return config;
}

}  // namespace fathom::cli

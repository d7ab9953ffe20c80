#include "sim/sensors/depth.hpp"

#include <algorithm>
#include <cmath>

#include "geo/so3.hpp"
#include "sim/encode/depth.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

DepthModel::DepthModel(const DepthConfig& config, std::uint64_t seed)
    : config_(config), random_(seed, "depth"), bias_m_(random_.normal(config.bias_sigma_m)) {}

std::optional<DepthSample> DepthModel::sample(const TruthPoint& point) {
  const double noise = random_.normal(config_.sigma_m);
  const bool outlier = random_.chance(config_.outlier_probability);
  const double depth_m = at_lever(point, geo::vec(config_.lever_B_m)).depth_m;
  if (config_.wet_only && depth_m < 0.0) return std::nullopt;
  DepthSample out;
  // In the air the port reads the atmosphere.
  out.depth_m = std::max(depth_m, 0.0) + bias_m_ + noise;
  if (outlier) out.depth_m += config_.outlier_m;
  if (config_.quantum_m > 0.0) out.depth_m = std::round(out.depth_m / config_.quantum_m) * config_.quantum_m;
  return out;
}

Bytes SimulatedDevice<DepthSample>::encode(const DepthSample& depth, const DeviceCall& device) {
  codec::CodecOptions options;
  options.latitude_rad = device.scenario.start.latitude_rad;
  if (device.protocol == "ascii_depth") return bytes_of(encode::ascii_depth(depth, options));
  return bytes_of(encode::paroscientific(depth, options));
}

}  // namespace fathom::sim

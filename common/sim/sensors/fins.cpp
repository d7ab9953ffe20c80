#include "sim/sensors/fins.hpp"

#include <cmath>

#include "sim/encode/nmea.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

FinsModel::FinsModel(const FinsConfig& config, std::uint64_t seed)
    : config_(config),
      random_(seed, "fins"),
      rudder_bias_rad_(random_.normal(config.bias_sigma_rad)),
      stern_bias_rad_(random_.normal(config.bias_sigma_rad)) {}

FinsSample FinsModel::sample(const TruthPoint& point) {
  FinsSample out;
  out.rudder_rad = point.rudder_rad + rudder_bias_rad_ + random_.normal(config_.sigma_rad);
  out.stern_rad = point.stern_rad + stern_bias_rad_ + random_.normal(config_.sigma_rad);
  return out;
}

Bytes SimulatedDevice<FinsSample>::encode(const FinsSample& fins, const DeviceCall& /*device*/) {
  return bytes_of(encode::nmea_fins(fins));
}

}  // namespace fathom::sim

#include "sim/sensors/propulsion.hpp"

#include <cmath>

#include "sim/encode/nmea.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

PropulsionModel::PropulsionModel(const PropulsionConfig& config, std::uint64_t seed)
    : config_(config), random_(seed, "propulsion"), scale_(random_.normal(config.scale_sigma)) {}

PropulsionSample PropulsionModel::sample(const TruthPoint& point) {
  PropulsionSample out;
  out.rpm = (1.0 + scale_) * point.rpm + random_.normal(config_.sigma_rpm);
  return out;
}

Bytes SimulatedDevice<PropulsionSample>::encode(const PropulsionSample& propulsion,
                                                const DeviceCall& /*device*/) {
  return bytes_of(encode::nmea_rpm(propulsion));
}

}  // namespace fathom::sim

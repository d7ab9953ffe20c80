#include "sim/sensors/fix.hpp"

#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/encode/fix_text.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

FixModel::FixModel(const FixConfig& config, std::uint64_t seed) : config_(config), random_(seed, "fix") {}

std::optional<FixSample> FixModel::sample(const TruthPoint& point) {
  Eigen::Vector3d error_N_m(random_.normal(config_.sigma_m), random_.normal(config_.sigma_m), 0.0);
  if (random_.chance(config_.outlier_probability)) error_N_m.x() += config_.outlier_m;
  const TruthPoint at = at_lever(point, geo::vec(config_.lever_B_m));
  if (at.depth_m < config_.minimum_depth_m) return std::nullopt;
  const geo::Geodetic told = geo::moved_by({at.latitude_rad, at.longitude_rad, at.altitude_m}, error_N_m);
  FixSample out;
  out.latitude_rad = told.latitude_rad;
  out.longitude_rad = told.longitude_rad;
  out.sigma_m = config_.sigma_m;
  return out;
}

Bytes SimulatedDevice<FixSample>::encode(const FixSample& fix, const DeviceCall& /*device*/) {
  return bytes_of(encode::fix_text(fix));
}

}  // namespace fathom::sim

#include "sim/sensors/altimeter.hpp"

#include "geo/so3.hpp"
#include "sim/encode/altimeter.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

AltimeterModel::AltimeterModel(const AltimeterConfig& config, std::uint64_t seed)
    : config_(config), random_(seed, "altimeter") {}

AltimeterSample AltimeterModel::sample(const TruthPoint& point) {
  // Drawn whatever is heard, so that a lost bottom leaves the later noise as it was.
  const double noise_m = random_.normal(config_.sigma_m);
  const bool outlier = random_.chance(config_.outlier_probability);
  const TruthPoint at = at_lever(point, geo::vec(config_.lever_B_m));
  const double steepness =
      (at.q_NB * Eigen::Vector3d::UnitZ()).z();  // cosine of the axis against the vertical
  AltimeterSample out;
  if (at.depth_m < 0.0 || steepness < 0.1 || inside(config_.dropouts, at.t_s)) return out;
  const double range_m = (at.water_depth_m - at.depth_m) / steepness;
  if (range_m < config_.minimum_range_m || range_m > config_.maximum_range_m) return out;
  out.altitude_m = range_m + noise_m + (outlier ? config_.outlier_m : 0.0);
  out.sigma_m = config_.sigma_m;
  return out;
}

Bytes SimulatedDevice<AltimeterSample>::encode(const AltimeterSample& altimeter, const DeviceCall& device) {
  if (device.protocol == "ping") return encode::ping_profile(altimeter, ++pings_);
  if (device.protocol == "ascii_altitude") return bytes_of(encode::ascii_altitude(altimeter));
  return bytes_of(encode::nmea_dpt(altimeter));
}

}  // namespace fathom::sim

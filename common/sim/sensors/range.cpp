#include "sim/sensors/range.hpp"

#include <algorithm>

#include "geo/so3.hpp"
#include "sim/encode/micromodem.hpp"
#include "sim/truth_generator.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {

RangeModel::RangeModel(const RangeConfig& config, const Scenario& scenario, std::uint64_t seed)
    : config_(config),
      random_(seed, "range"),
      start_{scenario.start.latitude_rad, scenario.start.longitude_rad,
             scenario.environment.surface_altitude_m} {
  Random survey(seed, "beacons");
  for (const SimulatedBeacon& one : config.beacons) {
    Eigen::Vector3d place_N_m = geo::vec(one.place_N_m);
    for (int i = 0; i < 2; ++i) place_N_m(i) += survey.normal(config.place_sigma_m);
    lie_at_.push_back(geo::moved_by(start_, place_N_m));
  }
}

RangeSample RangeModel::sample(const TruthPoint& point) {
  const double noise_m = random_.normal(config_.sigma_m);
  const bool echo = random_.chance(config_.outlier_probability);
  const SimulatedBeacon& beacon = config_.beacons[next_];
  const geo::Geodetic& lies_at = lie_at_[next_];
  next_ = (next_ + 1) % config_.beacons.size();
  const TruthPoint modem = at_lever(point, geo::vec(config_.lever_B_m));
  const double true_range_m =
      geo::difference_N(lies_at, {modem.latitude_rad, modem.longitude_rad, modem.altitude_m}).norm();
  travel_time_s_ = true_range_m / config_.sound_speed_m_s;
  RangeSample out;
  out.beacon = std::string_view(beacon.address);
  const bool answered = modem.depth_m >= config_.minimum_depth_m && true_range_m <= config_.maximum_range_m;
  if (!answered || inside(config_.dropouts, point.t_s)) return out;
  out.range_m = std::max(true_range_m + noise_m + (echo ? config_.outlier_m : 0.0), 0.01);
  out.sigma_m = config_.sigma_m;
  out.travel_time_s = out.range_m / config_.sound_speed_m_s;
  const geo::Geodetic place = geo::moved_by(start_, geo::vec(beacon.place_N_m));  // as it is said
  out.beacon_latitude_rad = place.latitude_rad;
  out.beacon_longitude_rad = place.longitude_rad;
  out.beacon_depth_m = start_.altitude_m - place.altitude_m;
  return out;
}

Bytes SimulatedDevice<RangeSample>::encode(const RangeSample& range, const DeviceCall& /*device*/) {
  return bytes_of(encode::micromodem(range));
}

}  // namespace fathom::sim

#include "sim/sensor_models.hpp"

#include <algorithm>
#include <cmath>

#include "codec/air/air_data.hpp"
#include "geo/so3.hpp"
#include "geo/wgs84.hpp"
#include "sim/vehicles/vehicle.hpp"

namespace fathom::sim {

using Eigen::Vector3d;

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

HeadingModel::HeadingModel(const HeadingConfig& config, const EnvironmentConfig& environment,
                           std::uint64_t seed)
    : config_(config),
      variation_rad_(environment.magnetic_variation_rad),
      random_(seed, "heading"),
      bias_rad_(random_.normal(config.bias_sigma_rad)) {}

HeadingSample HeadingModel::sample(const TruthPoint& point) {
  const double noise = random_.normal(config_.sigma_rad);
  const bool outlier = random_.chance(config_.outlier_probability);
  const double yaw = rpy_of(point.q_NB).z();
  const auto& d = config_.deviation_rad;
  double heading = yaw + bias_rad_ + noise + d[0] + d[1] * std::sin(yaw) + d[2] * std::cos(yaw) +
                   d[3] * std::sin(2.0 * yaw) + d[4] * std::cos(2.0 * yaw);
  if (outlier) heading += config_.outlier_rad;
  HeadingSample out;
  if (config_.magnetic) {
    out.north = North::magnetic;
    out.variation_rad = variation_rad_;
    heading -= variation_rad_;
  }
  out.heading_rad = geo::wrap_two_pi(heading);
  return out;
}

PropulsionModel::PropulsionModel(const PropulsionConfig& config, std::uint64_t seed)
    : config_(config), random_(seed, "propulsion"), scale_(random_.normal(config.scale_sigma)) {}

PropulsionSample PropulsionModel::sample(const TruthPoint& point) {
  PropulsionSample out;
  out.rpm = (1.0 + scale_) * point.rpm + random_.normal(config_.sigma_rpm);
  return out;
}

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

AirspeedModel::AirspeedModel(const AirspeedConfig& config, const EnvironmentConfig& environment,
                             std::uint64_t seed)
    : config_(config),
      air_warmer_K_(environment.air_temperature_offset_K),
      random_(seed, "airspeed"),
      scale_(random_.normal(config.scale_sigma)),
      baro_bias_m_(random_.normal(config.baro_bias_sigma_m)) {}

AirspeedSample AirspeedModel::sample(const TruthPoint& point) {
  AirspeedSample out;
  const double air_K = codec::standard_temperature_K(point.altitude_m) + air_warmer_K_;
  const double static_Pa = codec::standard_pressure_Pa(point.altitude_m);
  const double impact_Pa = codec::impact_pressure_at_Pa(point.V_B_m_s.x(), static_Pa, air_K);
  out.airspeed_m_s =
      (1.0 + scale_) * codec::indicated_airspeed_m_s(impact_Pa) + random_.normal(config_.sigma_m_s);
  out.baro_altitude_m = point.altitude_m + baro_bias_m_ + random_.normal(config_.baro_sigma_m);
  out.sigma_m_s = config_.sigma_m_s;
  // What the instrument makes of its own three readings.
  out.true_airspeed_m_s = codec::mach_number(codec::impact_pressure_Pa(out.airspeed_m_s),
                                             codec::standard_pressure_Pa(out.baro_altitude_m)) *
                          codec::speed_of_sound_m_s(air_K);
  return out;
}

}  // namespace fathom::sim

#include "sim/sensors/airspeed.hpp"

#include <cmath>

#include "codec/air/air_data.hpp"
#include "sim/encode/air_data.hpp"
#include "sim/truth_generator.hpp"

namespace fathom::sim {

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

Bytes SimulatedDevice<AirspeedSample>::encode(const AirspeedSample& airspeed, const DeviceCall& device) {
  if (device.protocol == "nmea_air_data") return bytes_of(encode::nmea_air_data(airspeed, {}));
  return bytes_of(encode::ascii_air_data(airspeed, {}));
}

}  // namespace fathom::sim

#include "sim/encode/air_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "codec/air/air_data.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "sim/encode/decimal.hpp"
#include "sim/encode/nmea.hpp"

namespace fathom::sim::encode {
namespace {

using codec::AirQuantity;
using codec::AirUnit;

double air_temperature_K(const AirspeedSample& sample) {
  const double static_Pa = codec::standard_pressure_Pa(sample.baro_altitude_m);
  const double mach = codec::mach_number(codec::impact_pressure_Pa(sample.airspeed_m_s), static_Pa);
  // Hardly any wind says nothing about the air.
  constexpr double kLeastMach = 0.02;
  if (!known(sample.true_airspeed_m_s) || !(mach > kLeastMach))
    return codec::standard_temperature_K(sample.baro_altitude_m);
  const double ratio = sample.true_airspeed_m_s / mach / codec::speed_of_sound_m_s(1.0);
  return ratio * ratio;
}

double quantity(const AirspeedSample& sample, AirQuantity which) {
  const double impact_Pa = codec::impact_pressure_Pa(sample.airspeed_m_s);
  const double static_Pa = codec::standard_pressure_Pa(sample.baro_altitude_m);
  switch (which) {
    case AirQuantity::indicated_airspeed:
      return sample.airspeed_m_s;
    case AirQuantity::true_airspeed:
      return sample.true_airspeed_m_s;
    case AirQuantity::impact_pressure:
      return impact_Pa;
    case AirQuantity::total_pressure:
      return static_Pa + impact_Pa;
    case AirQuantity::static_pressure:
      return static_Pa;
    case AirQuantity::pressure_altitude:
      return sample.baro_altitude_m;
    case AirQuantity::static_temperature:
      return air_temperature_K(sample);
    case AirQuantity::total_temperature: {
      const double mach = codec::mach_number(impact_Pa, static_Pa);
      const double air_K = air_temperature_K(sample);
      return air_K * air_K / codec::static_temperature_K(air_K, mach);
    }
    case AirQuantity::ignored:
      break;
  }
  return kUnknown;
}

}  // namespace

std::string ascii_air_data(const AirspeedSample& sample, const codec::CodecOptions& options) {
  const codec::AirDataOptions& shape = options.air_data;
  std::string line = shape.prefix.str();
  for (std::size_t i = 0; i < shape.count; ++i) {
    if (i > 0) line += shape.separator;
    const codec::AirColumn& column = shape.columns[i];
    line += decimal(codec::from_si(quantity(sample, column.quantity), column.unit), 4);
  }
  const std::string_view summed = line.starts_with('$') ? std::string_view(line).substr(1) : line;
  std::array<char, 8> tail{};
  (void)std::snprintf(tail.data(), tail.size(), "*%02X\r\n", codec::nmea_checksum(summed));
  return line + tail.data();
}

std::string nmea_air_data(const AirspeedSample& sample, const codec::CodecOptions& options) {
  const auto transducer = [&](const char* type, AirQuantity which, AirUnit unit, int decimals,
                              const char* letter) {
    return std::string(",") + type + "," + decimal(codec::from_si(quantity(sample, which), unit), decimals) +
           "," + letter + "," + options.air_data.transducer[static_cast<std::size_t>(which)].str();
  };
  return nmea_sentence("IIXDR" + transducer("P", AirQuantity::impact_pressure, AirUnit::Pa, 2, "P") +
                       transducer("P", AirQuantity::static_pressure, AirUnit::Pa, 1, "P") +
                       transducer("C", AirQuantity::static_temperature, AirUnit::degC, 2, "C"));
}

}  // namespace fathom::sim::encode

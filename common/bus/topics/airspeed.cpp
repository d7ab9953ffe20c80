#include "samples/airspeed.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<AirspeedSample> {
  using Wire = v1::AirspeedSample;
  static constexpr const char* kTopic = KindOf<AirspeedSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::AirspeedSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.airspeed_m_s, wire.airspeed_m_s());
    copy(plain.baro_altitude_m, wire.baro_altitude_m());
    copy(plain.sigma_m_s, wire.sigma_m_s());
    copy(plain.true_airspeed_m_s, wire.true_airspeed_m_s());
  }

  static std::string key_text(const AirspeedSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(AirspeedSample)

#include "samples/altimeter.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<AltimeterSample> {
  using Wire = v1::AltimeterSample;
  static constexpr const char* kTopic = KindOf<AltimeterSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::AltimeterSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.altitude_m, wire.altitude_m());
    copy(plain.sigma_m, wire.sigma_m());
    copy(plain.transducer_offset_m, wire.transducer_offset_m());
    copy(plain.vertical, wire.vertical());
  }

  static std::string key_text(const AltimeterSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(AltimeterSample)

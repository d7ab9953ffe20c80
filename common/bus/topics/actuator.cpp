#include "samples/actuator.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<PropulsionSample> {
  using Wire = v1::PropulsionSample;
  static constexpr const char* kTopic = KindOf<PropulsionSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::PropulsionSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.rpm, wire.rpm());
  }

  static std::string key_text(const PropulsionSample& sample) { return vehicle_and_sensor(sample); }
};

template <>
struct Mapping<FinsSample> {
  using Wire = v1::FinsSample;
  static constexpr const char* kTopic = KindOf<FinsSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::FinsSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.rudder_rad, wire.rudder_rad());
    copy(plain.stern_rad, wire.stern_rad());
  }

  static std::string key_text(const FinsSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(PropulsionSample)
FATHOM_BUS_TOPIC(FinsSample)

#include "samples/depth.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<DepthSample> {
  using Wire = v1::DepthSample;
  static constexpr const char* kTopic = KindOf<DepthSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::DepthSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.depth_m, wire.depth_m());
    copy(plain.sigma_m, wire.sigma_m());
    copy(plain.pressure_Pa, wire.pressure_Pa());
    copy(plain.temperature_degC, wire.temperature_degC());
  }

  static std::string key_text(const DepthSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(DepthSample)

#include "samples/position/fix.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<FixSample> {
  using Wire = v1::FixSample;
  static constexpr const char* kTopic = KindOf<FixSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::FixSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.latitude_rad, wire.latitude_rad());
    copy(plain.longitude_rad, wire.longitude_rad());
    copy(plain.sigma_m, wire.sigma_m());
    copy(plain.depth_m, wire.depth_m());
    copy(plain.depth_sigma_m, wire.depth_sigma_m());
  }

  static std::string key_text(const FixSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(FixSample)

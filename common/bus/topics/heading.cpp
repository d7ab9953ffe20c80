#include "samples/heading.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<HeadingSample> {
  using Wire = v1::HeadingSample;
  static constexpr const char* kTopic = KindOf<HeadingSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::HeadingSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<North::magnetic, v1::North::NORTH_MAGNETIC>(copy, plain.north, wire.north());
    copy(plain.heading_rad, wire.heading_rad());
    copy(plain.sigma_rad, wire.sigma_rad());
    copy(plain.variation_rad, wire.variation_rad());
    copy(plain.deviation_rad, wire.deviation_rad());
  }

  static std::string key_text(const HeadingSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(HeadingSample)

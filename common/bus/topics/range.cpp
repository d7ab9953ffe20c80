#include "samples/range.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<RangeSample> {
  using Wire = v1::RangeSample;
  static constexpr const char* kTopic = KindOf<RangeSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::RangeSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.beacon, wire.beacon());
    copy(plain.range_m, wire.range_m());
    copy(plain.sigma_m, wire.sigma_m());
    copy(plain.travel_time_s, wire.travel_time_s());
    copy(plain.beacon_latitude_rad, wire.beacon_latitude_rad());
    copy(plain.beacon_longitude_rad, wire.beacon_longitude_rad());
    copy(plain.beacon_depth_m, wire.beacon_depth_m());
  }

  static std::string key_text(const RangeSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(RangeSample)

#include "samples/usbl.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<UsblSample> {
  using Wire = v1::UsblSample;
  static constexpr const char* kTopic = KindOf<UsblSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::UsblSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<UsblFrame::vehicle_frd, v1::UsblFrame::USBL_FRAME_VEHICLE_FRD>(copy, plain.frame, wire.frame());
    copy(plain.transponder, wire.transponder());
    copy(plain.latitude_rad, wire.latitude_rad());
    copy(plain.longitude_rad, wire.longitude_rad());
    copy(plain.depth_m, wire.depth_m());
    copy(plain.relative_m, wire.relative_m());
    copy(plain.range_m, wire.range_m());
    copy(plain.bearing_rad, wire.bearing_rad());
    copy(plain.depression_rad, wire.depression_rad());
    copy(plain.sigma_m, wire.sigma_m());
    copy(plain.sigma_rad, wire.sigma_rad());
    copy(plain.travel_time_s, wire.travel_time_s());
    copy(plain.station_latitude_rad, wire.station_latitude_rad());
    copy(plain.station_longitude_rad, wire.station_longitude_rad());
    copy(plain.station_depth_m, wire.station_depth_m());
    copy(plain.station_rpy_rad, wire.station_rpy_rad());
  }

  static std::string key_text(const UsblSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(UsblSample)

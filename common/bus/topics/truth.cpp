#include "samples/truth.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/navigation.h"

namespace fathom::bus::detail {

template <>
struct Mapping<Truth> {
  using Wire = v1::Truth;
  static constexpr const char* kTopic = "fathom/v1/truth";
  static constexpr const char* kType = "fathom::v1::Truth";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy(plain.latitude_rad, wire.latitude_rad());
    copy(plain.longitude_rad, wire.longitude_rad());
    copy(plain.altitude_m, wire.altitude_m());
    copy(plain.velocity_N_m_s, wire.velocity_N_m_s());
    copy(plain.rpy_rad, wire.rpy_rad());
    copy(plain.gps_available, wire.gps_available());
  }

  static std::string key_text(const Truth& sample) { return sample.header.vehicle.str(); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(Truth)

#include "samples/gps.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<GpsSample> {
  using Wire = v1::GpsSample;
  static constexpr const char* kTopic = KindOf<GpsSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::GpsSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<GpsFix::rtk_fixed, v1::GpsFix::GPS_FIX_RTK_FIXED>(copy, plain.fix, wire.fix());
    copy(plain.satellites, wire.satellites());
    copy(plain.latitude_rad, wire.latitude_rad());
    copy(plain.longitude_rad, wire.longitude_rad());
    copy(plain.altitude_m, wire.altitude_m());
    copy(plain.altitude_msl_m, wire.altitude_msl_m());
    copy(plain.position_sigma_N_m, wire.position_sigma_N_m());
    copy(plain.velocity_N_m_s, wire.velocity_N_m_s());
    copy(plain.velocity_sigma_N_m_s, wire.velocity_sigma_N_m_s());
    copy(plain.hdop, wire.hdop());
    copy(plain.course_rad, wire.course_rad());
    copy_enum<GpsJamming::critical, v1::GpsJamming::GPS_JAMMING_CRITICAL>(copy, plain.jamming,
                                                                          wire.jamming());
    copy_enum<GpsSpoofing::affirmed, v1::GpsSpoofing::GPS_SPOOFING_AFFIRMED>(copy, plain.spoofing,
                                                                             wire.spoofing());
  }

  static std::string key_text(const GpsSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(GpsSample)

#include "samples/dvl.hpp"

#include "bus/detail/mapping.hpp"
#include "idl/sensors.h"
#include "samples/kinds.hpp"

namespace fathom::bus::detail {

template <>
struct Mapping<DvlSample> {
  using Wire = v1::DvlSample;
  static constexpr const char* kTopic = KindOf<DvlSample>::kTopic.data();
  static constexpr const char* kType = "fathom::v1::DvlSample";

  static void fields(auto& copy, auto& plain, auto& wire) {
    copy_header(copy, plain.header, wire);
    copy_enum<DvlMode::water, v1::DvlMode::DVL_MODE_WATER>(copy, plain.mode, wire.mode());
    copy_enum<DvlFrame::earth, v1::DvlFrame::DVL_FRAME_EARTH>(copy, plain.recorded_frame,
                                                              wire.recorded_frame());
    copy(plain.velocity_D_m_s, wire.velocity_D_m_s());
    copy(plain.error_velocity_m_s, wire.error_velocity_m_s());
    copy(plain.sigma_m_s, wire.sigma_m_s());
    copy(plain.beam_velocity_m_s, wire.beam_velocity_m_s());
    copy(plain.beam_range_m, wire.beam_range_m());
    copy(plain.beam_angle_rad, wire.beam_angle_rad());
    copy(plain.altitude_m, wire.altitude_m());
    copy(plain.sound_speed_m_s, wire.sound_speed_m_s());
    copy(plain.roll_rad, wire.roll_rad());
    copy(plain.pitch_rad, wire.pitch_rad());
    copy(plain.heading_rad, wire.heading_rad());
  }

  static std::string key_text(const DvlSample& sample) { return vehicle_and_sensor(sample); }
};

}  // namespace fathom::bus::detail

FATHOM_BUS_TOPIC(DvlSample)

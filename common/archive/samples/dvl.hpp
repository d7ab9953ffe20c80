#pragma once

#include "archive/samples/header.hpp"
#include "samples/dvl.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, DvlSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("mode", self.mode, DvlMode::water);
  archive("recorded_frame", self.recorded_frame, DvlFrame::earth);
  archive("velocity_D_m_s", self.velocity_D_m_s, kAny);
  archive("error_velocity_m_s", self.error_velocity_m_s, kAny);
  archive("sigma_m_s", self.sigma_m_s, kAny);
  archive("beam_velocity_m_s", self.beam_velocity_m_s, kAny);
  archive("beam_range_m", self.beam_range_m, kAny);
  archive("beam_angle_rad", self.beam_angle_rad, kAny);
  archive("altitude_m", self.altitude_m, kAny);
  archive("sound_speed_m_s", self.sound_speed_m_s, kAny);
  archive("roll_rad", self.roll_rad, kAny);
  archive("pitch_rad", self.pitch_rad, kAny);
  archive("heading_rad", self.heading_rad, kAny);
}

}  // namespace fathom

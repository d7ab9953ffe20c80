#pragma once

#include "archive/samples/header.hpp"
#include "samples/gps.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, GpsSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("fix", self.fix, GpsFix::rtk_fixed);
  archive("satellites", self.satellites, fathom::archive::kAnyWhole);
  archive("latitude_rad", self.latitude_rad, kAny);
  archive("longitude_rad", self.longitude_rad, kAny);
  archive("altitude_m", self.altitude_m, kAny);
  archive("altitude_msl_m", self.altitude_msl_m, kAny);
  archive("position_sigma_N_m", self.position_sigma_N_m, kAny);
  archive("velocity_N_m_s", self.velocity_N_m_s, kAny);
  archive("velocity_sigma_N_m_s", self.velocity_sigma_N_m_s, kAny);
  archive("hdop", self.hdop, kAny);
  archive("course_rad", self.course_rad, kAny);
  archive("jamming", self.jamming, GpsJamming::critical);
  archive("spoofing", self.spoofing, GpsSpoofing::affirmed);
}

}  // namespace fathom

#pragma once

#include "archive/samples/header.hpp"
#include "samples/airspeed.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, AirspeedSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("airspeed_m_s", self.airspeed_m_s, kAny);
  archive("baro_altitude_m", self.baro_altitude_m, kAny);
  archive("sigma_m_s", self.sigma_m_s, kAny);
  archive("true_airspeed_m_s", self.true_airspeed_m_s, kAny);
}

}  // namespace fathom

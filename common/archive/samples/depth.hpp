#pragma once

#include "archive/samples/header.hpp"
#include "samples/depth.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, DepthSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("depth_m", self.depth_m, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("pressure_Pa", self.pressure_Pa, kAny);
  archive("temperature_degC", self.temperature_degC, kAny);
}

}  // namespace fathom

#pragma once

#include "archive/samples/header.hpp"
#include "samples/position/fix.hpp"

namespace fathom {

template <>
inline constexpr std::uint32_t archive::kSince<FixSample> = 7;

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, FixSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("latitude_rad", self.latitude_rad, kAny);
  archive("longitude_rad", self.longitude_rad, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("depth_m", self.depth_m, kAny);
  archive("depth_sigma_m", self.depth_sigma_m, kAny);
}

}  // namespace fathom

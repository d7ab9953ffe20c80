#pragma once

#include "archive/samples/header.hpp"
#include "samples/heading.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, HeadingSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("north", self.north, North::magnetic);
  archive("heading_rad", self.heading_rad, kAny);
  archive("sigma_rad", self.sigma_rad, kAny);
  archive("variation_rad", self.variation_rad, kAny);
  archive("deviation_rad", self.deviation_rad, kAny);
}

}  // namespace fathom

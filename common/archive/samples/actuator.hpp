#pragma once

#include "archive/samples/header.hpp"
#include "samples/actuator.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, PropulsionSample>
void fields(Archive& archive, Self& self) {
  archive("header", self.header);
  archive("rpm", self.rpm, fathom::archive::any_number());
}

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, FinsSample>
void fields(Archive& archive, Self& self) {
  archive("header", self.header);
  archive("rudder_rad", self.rudder_rad, fathom::archive::any_number());
  archive("stern_rad", self.stern_rad, fathom::archive::any_number());
}

}  // namespace fathom

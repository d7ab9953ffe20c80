#pragma once

#include "archive/samples/header.hpp"
#include "samples/command.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, Command>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("kind", self.kind, CommandKind::mark_at_rest);
  archive("target", self.target);
  archive("latitude_rad", self.latitude_rad, kAny);
  archive("longitude_rad", self.longitude_rad, kAny);
  archive("depth_m", self.depth_m, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("value_s", self.value_s, kAny);
  if (archive.since(2)) archive("confirmed", self.confirmed);
}

}  // namespace fathom

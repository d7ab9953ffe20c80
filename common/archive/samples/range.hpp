#pragma once

#include "archive/samples/header.hpp"
#include "samples/range.hpp"

namespace fathom {

template <>
inline constexpr std::uint32_t archive::kSince<RangeSample> = 3;

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, RangeSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("beacon", self.beacon);
  archive("range_m", self.range_m, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("travel_time_s", self.travel_time_s, kAny);
  archive("beacon_latitude_rad", self.beacon_latitude_rad, kAny);
  archive("beacon_longitude_rad", self.beacon_longitude_rad, kAny);
  archive("beacon_depth_m", self.beacon_depth_m, kAny);
}

}  // namespace fathom

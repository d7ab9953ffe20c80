#pragma once

#include "archive/samples/header.hpp"
#include "samples/usbl.hpp"

namespace fathom {

template <class Archive, class Self>
requires std::is_same_v<std::remove_const_t<Self>, UsblSample>
void fields(Archive& archive, Self& self) {
  constexpr fathom::archive::Range kAny = fathom::archive::any_number();
  archive("header", self.header);
  archive("frame", self.frame, UsblFrame::vehicle_frd);
  archive("transponder", self.transponder);
  archive("latitude_rad", self.latitude_rad, kAny);
  archive("longitude_rad", self.longitude_rad, kAny);
  archive("depth_m", self.depth_m, kAny);
  archive("relative_m", self.relative_m, kAny);
  archive("range_m", self.range_m, kAny);
  archive("bearing_rad", self.bearing_rad, kAny);
  archive("depression_rad", self.depression_rad, kAny);
  archive("sigma_m", self.sigma_m, kAny);
  archive("sigma_rad", self.sigma_rad, kAny);
  archive("travel_time_s", self.travel_time_s, kAny);
  archive("station_latitude_rad", self.station_latitude_rad, kAny);
  archive("station_longitude_rad", self.station_longitude_rad, kAny);
  archive("station_depth_m", self.station_depth_m, kAny);
  archive("station_rpy_rad", self.station_rpy_rad, kAny);
}

}  // namespace fathom

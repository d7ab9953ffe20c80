#include "samples/usbl.hpp"

#include <numbers>

#include "base/unknown.hpp"
#include "bridge/sanity/place.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const UsblSample& s, const Limits& limits) {
  const bool geodetic = s.frame == UsblFrame::geodetic;
  const bool polar = !geodetic && (known(s.range_m) || known(s.bearing_rad));
  Judge judge;
  if (geodetic) {
    judge.numbers("latitude_rad", s.latitude_rad).numbers("longitude_rad", s.longitude_rad);
  } else if (!polar) {
    judge.numbers("relative_m[0]", s.relative_m[0]).numbers("relative_m[1]", s.relative_m[1]);
  }
  judge.finite("depth_m", s.depth_m)
      .finite("sigma_m", s.sigma_m)
      .finite("travel_time_s", s.travel_time_s)
      .finite("relative_m[2]", s.relative_m[2])
      .finite("range_m", s.range_m)
      .finite("bearing_rad", s.bearing_rad)
      .finite("depression_rad", s.depression_rad)
      .finite("sigma_rad", s.sigma_rad)
      .finite("station_depth_m", s.station_depth_m)
      .finite("station_rpy_rad", s.station_rpy_rad)
      .at_most("relative_m", s.relative_m, limits.acoustic_range_m)
      .at_most("depth_m", s.depth_m, limits.depth_m)
      .not_negative("sigma_m", s.sigma_m)
      .positive("range_m", s.range_m)
      .at_most("range_m", s.range_m, limits.acoustic_range_m)
      .at_most("depression_rad", s.depression_rad, 0.5 * std::numbers::pi)
      .at_most("bearing_rad", s.bearing_rad, 2.0 * std::numbers::pi);
  place(judge, "station_latitude_rad", s.station_latitude_rad, "station_longitude_rad",
        s.station_longitude_rad);
  return place(judge, "latitude_rad", s.latitude_rad, "longitude_rad", s.longitude_rad).verdict();
}

}  // namespace fathom::bridge

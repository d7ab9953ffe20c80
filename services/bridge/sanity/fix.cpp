#include "samples/position/fix.hpp"

#include "bridge/sanity/place.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const FixSample& s, const Limits& limits) {
  Judge judge;
  judge.numbers("latitude_rad", s.latitude_rad)
      .numbers("longitude_rad", s.longitude_rad)
      .numbers("sigma_m", s.sigma_m)
      .finite("depth_m", s.depth_m)
      .finite("depth_sigma_m", s.depth_sigma_m)
      .positive("sigma_m", s.sigma_m)
      .positive("depth_sigma_m", s.depth_sigma_m)
      .at_most("depth_m", s.depth_m, limits.depth_m);
  return place(judge, "latitude_rad", s.latitude_rad, "longitude_rad", s.longitude_rad).verdict();
}

}  // namespace fathom::bridge

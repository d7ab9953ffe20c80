#include "samples/range.hpp"

#include "bridge/sanity/place.hpp"

namespace fathom::bridge {

template <>
Judgement judge(const RangeSample& s, const Limits& limits) {
  Judge judge;
  judge.numbers("range_m", s.range_m)
      .finite("sigma_m", s.sigma_m)
      .finite("travel_time_s", s.travel_time_s)
      .finite("beacon_depth_m", s.beacon_depth_m)
      .positive("range_m", s.range_m)
      .at_most("range_m", s.range_m, limits.acoustic_range_m)
      .not_negative("sigma_m", s.sigma_m);
  return place(judge, "beacon_latitude_rad", s.beacon_latitude_rad, "beacon_longitude_rad",
               s.beacon_longitude_rad)
      .verdict();
}

}  // namespace fathom::bridge

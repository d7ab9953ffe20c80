#include "samples/range.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const RangeSample& s) {
  line["beacon"] = s.beacon.view();
  line["range_m"] = s.range_m;
  line["sigma_m"] = s.sigma_m;
  line["travel_time_s"] = s.travel_time_s;
  line["beacon_lat_deg"] = degrees(s.beacon_latitude_rad);
  line["beacon_lon_deg"] = degrees(s.beacon_longitude_rad);
  line["beacon_depth_m"] = s.beacon_depth_m;
}

}  // namespace fathom::cli

#include "samples/position/fix.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const FixSample& s) {
  line["lat_deg"] = degrees(s.latitude_rad);
  line["lon_deg"] = degrees(s.longitude_rad);
  line["sigma_m"] = s.sigma_m;
  line["depth_m"] = s.depth_m;
  line["depth_sigma_m"] = s.depth_sigma_m;
}

}  // namespace fathom::cli

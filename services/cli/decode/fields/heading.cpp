#include "samples/heading.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const HeadingSample& s) {
  line["heading_deg"] = degrees(s.heading_rad);
  line["sigma_deg"] = degrees(s.sigma_rad);
  line["north"] = s.north == North::true_north ? "true" : "magnetic";
  line["variation_deg"] = degrees(s.variation_rad);
  line["deviation_deg"] = degrees(s.deviation_rad);
}

}  // namespace fathom::cli

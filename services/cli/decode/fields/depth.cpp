#include "samples/depth.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const DepthSample& s) {
  line["depth_m"] = s.depth_m;
  line["sigma_m"] = s.sigma_m;
  line["pressure_Pa"] = s.pressure_Pa;
  line["temperature_degC"] = s.temperature_degC;
}

}  // namespace fathom::cli

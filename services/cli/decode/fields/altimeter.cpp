#include "samples/altimeter.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const AltimeterSample& s) {
  line["altitude_m"] = s.altitude_m;
  line["sigma_m"] = s.sigma_m;
  line["transducer_offset_m"] = s.transducer_offset_m;
  line["along"] = s.vertical ? "vertical" : "axis";
}

}  // namespace fathom::cli

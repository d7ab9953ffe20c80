#include "samples/airspeed.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const AirspeedSample& s) {
  line["airspeed_m_s"] = s.airspeed_m_s;
  line["true_airspeed_m_s"] = s.true_airspeed_m_s;
  line["baro_alt_m"] = s.baro_altitude_m;
}

}  // namespace fathom::cli

#include "samples/actuator.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {

template <>
void add_fields(Json& line, const PropulsionSample& s) {
  line["rpm"] = s.rpm;
}

template <>
void add_fields(Json& line, const FinsSample& s) {
  line["rudder_rad"] = s.rudder_rad;
  line["stern_rad"] = s.stern_rad;
}

}  // namespace fathom::cli

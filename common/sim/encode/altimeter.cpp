#include "sim/encode/altimeter.hpp"

#include "sim/encode/decimal.hpp"
#include "sim/encode/nmea.hpp"

namespace fathom::sim::encode {

std::string nmea_dpt(const AltimeterSample& sample) {
  const double offset_m = known(sample.transducer_offset_m) ? sample.transducer_offset_m : 0.0;
  return nmea_sentence("SDDPT," + decimal(sample.altitude_m, 2) + "," + decimal(offset_m, 2));
}

}  // namespace fathom::sim::encode

#include "sim/encode/micromodem.hpp"

#include "sim/encode/decimal.hpp"
#include "sim/encode/nmea.hpp"

namespace fathom::sim::encode {

std::string micromodem(const RangeSample& sample) {
  return nmea_sentence("CAMPR," + sample.beacon.str() + ",1," + decimal(sample.travel_time_s, 4));
}

}  // namespace fathom::sim::encode

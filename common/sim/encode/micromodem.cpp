#include "sim/encode/micromodem.hpp"

#include <array>
#include <cstdio>

#include "sim/encode/nmea.hpp"

namespace fathom::sim::encode {

std::string micromodem(const RangeSample& sample) {
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.4f", sample.travel_time_s);
  return nmea_sentence("CAMPR," + sample.beacon.str() + ",1," + text.data());
}

}  // namespace fathom::sim::encode

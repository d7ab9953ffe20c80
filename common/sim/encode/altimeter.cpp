#include "sim/encode/altimeter.hpp"

#include <array>
#include <cstdio>

#include "sim/encode/nmea.hpp"

namespace fathom::sim::encode {
namespace {

std::string centimetres(double value_m) {
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.2f", value_m);
  return text.data();
}

}  // namespace

std::string nmea_dpt(const AltimeterSample& sample) {
  const double offset_m = known(sample.transducer_offset_m) ? sample.transducer_offset_m : 0.0;
  return nmea_sentence("SDDPT," +
                       (known(sample.altitude_m) ? centimetres(sample.altitude_m) : std::string()) + "," +
                       centimetres(offset_m));
}

}  // namespace fathom::sim::encode

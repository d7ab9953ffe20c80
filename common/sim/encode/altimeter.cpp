#include "sim/encode/altimeter.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/bytes/little_endian.hpp"
#include "sim/encode/decimal.hpp"
#include "sim/encode/nmea.hpp"

namespace fathom::sim::encode {
namespace {

constexpr std::uint16_t kProfile = 1300;
constexpr std::uint16_t kStrengths = 200;
constexpr std::size_t kHeader = 8;
constexpr std::uint32_t kScan_mm = 100'000;
constexpr double kOfStrength_mm = static_cast<double>(kScan_mm) / kStrengths;

}  // namespace

std::string nmea_dpt(const AltimeterSample& sample) {
  const double offset_m = known(sample.transducer_offset_m) ? sample.transducer_offset_m : 0.0;
  return nmea_sentence("SDDPT," + decimal(sample.altitude_m, 2) + "," + decimal(offset_m, 2));
}

std::string ascii_altitude(const AltimeterSample& sample) {
  return decimal(known(sample.altitude_m) ? sample.altitude_m : 0.0, 3) + "m\r\n";
}

std::vector<std::uint8_t> ping_profile(const AltimeterSample& sample, std::uint32_t number) {
  const bool heard = known(sample.altitude_m);
  const double range_mm = heard ? std::max(0.0, std::round(1e3 * sample.altitude_m)) : 0.0;
  std::vector<std::uint8_t> out{'B', 'R', 0, 0};
  append_le<std::uint16_t>(out, kProfile);
  out.push_back(1);  // from
  out.push_back(0);  // to
  append_le<std::uint32_t>(out, static_cast<std::uint32_t>(range_mm));
  append_le<std::uint16_t>(out, heard ? 100 : 0);
  append_le<std::uint16_t>(out, 125);  // us of sound
  append_le<std::uint32_t>(out, number);
  append_le<std::uint32_t>(out, 0);  // mm, from where
  append_le<std::uint32_t>(out, kScan_mm);
  append_le<std::uint32_t>(out, 3);  // gain
  append_le<std::uint16_t>(out, kStrengths);
  for (int i = 0; i < kStrengths; ++i) {
    const double away = std::abs((i + 0.5) * kOfStrength_mm - range_mm);
    out.push_back(heard && away < kOfStrength_mm ? 255 : 10);
  }
  store_le<std::uint16_t>(out, 2, static_cast<std::uint16_t>(out.size() - kHeader));
  append_le<std::uint16_t>(out, std::accumulate(out.begin(), out.end(), std::uint16_t{0}));
  return out;
}

}  // namespace fathom::sim::encode

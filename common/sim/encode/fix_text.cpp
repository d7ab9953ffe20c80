#include "sim/encode/fix_text.hpp"

#include "base/units.hpp"
#include "sim/encode/decimal.hpp"
#include "sim/encode/nmea.hpp"

namespace fathom::sim::encode {

std::string fix_text(const FixSample& sample) {
  std::string body = "PFTHX," + to_iso8601(sample.header.stamp_ns) + ',' +
                     decimal(kDegPerRad * sample.latitude_rad, 8) + ',' +
                     decimal(kDegPerRad * sample.longitude_rad, 8) + ',' + decimal(sample.sigma_m, 2);
  if (known(sample.depth_m))
    body += ',' + decimal(sample.depth_m, 2) + ',' + decimal(sample.depth_sigma_m, 2);
  return nmea_sentence(body);
}

}  // namespace fathom::sim::encode

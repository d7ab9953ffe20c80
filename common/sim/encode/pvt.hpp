#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"

namespace fathom::sim::encode {

/// The 72 bytes that UBX NAV-PVT and the item GNSS PVT Data of an Xsens unit begin with, in either byte
/// order; the satellites stand at `satellites_at`. Time is fully resolved. hAcc is the radius of the two
/// horizontal sigmas, sAcc the largest velocity sigma; unknown accuracies are the largest number. Without fix
/// gnssFixOK is 0. Resolution: 1e-7 degree, 1 mm, 1 mm/s.
[[nodiscard]] std::vector<std::uint8_t> pvt_fields(const GpsSample& sample, TimeNs utc_ns, std::endian order,
                                                   std::size_t satellites_at);

/// A dilution of precision in hundredths; unknown is 9999.
[[nodiscard]] std::uint16_t pvt_dilution(double value);

}  // namespace fathom::sim::encode

#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"

namespace fathom::sim::encode {

/// A UBX frame of any class: sync, class, id, length, payload, checksum.
[[nodiscard]] std::vector<std::uint8_t> ubx_frame(std::uint8_t message_class, std::uint8_t message_id,
                                                  std::span<const std::uint8_t> payload);

/// UBX NAV-PVT (92 bytes), time fully resolved. hAcc is the radius of the two horizontal sigmas, sAcc the
/// largest velocity sigma; unknown accuracies are sent as the largest number. Without fix gnssFixOK is 0 and
/// the position is marked invalid. Resolution: 1e-7 degree, 1 mm, 1 mm/s.
[[nodiscard]] std::vector<std::uint8_t> ubx_nav_pvt(const GpsSample& sample, TimeNs utc_ns);

}  // namespace fathom::sim::encode

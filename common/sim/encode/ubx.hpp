#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/time.hpp"
#include "samples/gps.hpp"
#include "samples/heading.hpp"

namespace fathom::sim::encode {

/// A UBX frame of any class: sync, class, id, length, payload, checksum.
[[nodiscard]] std::vector<std::uint8_t> ubx_frame(std::uint8_t message_class, std::uint8_t message_id,
                                                  std::span<const std::uint8_t> payload);

/// UBX NAV-PVT (92 bytes), with the accuracies and the resolution of pvt_fields() (pvt.hpp). Without fix the
/// position is marked invalid.
[[nodiscard]] std::vector<std::uint8_t> ubx_nav_pvt(const GpsSample& sample, TimeNs utc_ns);

/// UBX NAV-RELPOSNED (64 bytes) of a moving base with fixed carrier phase; without a true heading it is not
/// valid.
[[nodiscard]] std::vector<std::uint8_t> ubx_nav_relposned(const HeadingSample& sample, TimeNs utc_ns);

}  // namespace fathom::sim::encode

#pragma once

#include <cstdint>
#include <vector>

#include "codec/registry.hpp"
#include "samples/imu.hpp"

namespace fathom::sim::encode {

/// What a datagram of a STIM300 says besides the sample.
struct Stim300Frame {
  std::uint8_t counter = 0;
  std::uint16_t latency_us = 0;
  bool line = false;  ///< ends with CR and LF
  codec::Stim300Options options;
};

/// One datagram of the normal mode: gyros and accelerometers, and all temperatures where the sample knows
/// one. Rates and forces, or with `increments_hz` increments, in whole counts. An axis that is unknown is
/// marked as in error, one beyond 24 bits as overloaded.
[[nodiscard]] std::vector<std::uint8_t> stim300(const ImuSample& sample, const Stim300Frame& frame);

/// The configuration datagram of such a unit. `rate_code`: sample rate, 125 Hz doubled so many times.
[[nodiscard]] std::vector<std::uint8_t> stim300_configuration(const codec::Stim300Options& options,
                                                              std::uint8_t rate_code);

}  // namespace fathom::sim::encode

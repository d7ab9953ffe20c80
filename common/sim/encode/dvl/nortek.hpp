#pragma once

#include <cstdint>
#include <vector>

#include "base/time.hpp"
#include "samples/dvl.hpp"

namespace fathom::sim::encode {

/// When a Nortek record was valid and when it leaves, on the instrument's own clock.
struct NortekTimes {
  TimeNs valid_ns = 0;
  TimeNs sent_ns = 0;
};

/// One record of the bottom track (DF21) or the water track (DF22), by the sample's mode, in single
/// precision. What the sample does not know is sent as not valid. An error velocity that it knows parts Z1
/// from Z2; without it the velocity is sent as one of three beams, without Z2. sigma_m_s is the figure of
/// merit of every axis. The trigger is 20 ms before the instant of validity, on whole 100 us. Which way the
/// beams look is the caller's.
[[nodiscard]] std::vector<std::uint8_t> nortek(const DvlSample& sample, const NortekTimes& times);

/// A record of any kind behind its header, of 10 or of 12 bytes.
[[nodiscard]] std::vector<std::uint8_t> nortek_record(std::uint8_t kind,
                                                      const std::vector<std::uint8_t>& data,
                                                      bool long_header = false);

}  // namespace fathom::sim::encode

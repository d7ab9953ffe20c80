#pragma once

#include <cstdint>

#include "base/name.hpp"
#include "base/time.hpp"

namespace fathom {

/// What every sample carries.
struct SampleHeader {
  Name vehicle;
  Name sensor;                 ///< which instrument, e.g. "gps0"; for status samples the service
  TimeNs stamp_ns = 0;         ///< instant of validity
  TimeNs received_ns = 0;      ///< arrival of the last byte at the bridge
  std::uint64_t sequence = 0;  ///< grows by one per sample of this writer
};

}  // namespace fathom

#pragma once

#include <optional>

#include "codec/framer.hpp"
#include "codec/registry.hpp"
#include "samples/depth.hpp"

namespace fathom::codec {

/// How the number of a pressure sensor becomes a depth.
struct DepthScale {
  double unit = 1.0;    ///< of one count, metres or pascal
  double offset = 0.0;  ///< added after scaling, metres or pascal
  bool value_is_depth = false;
  double atmosphere_Pa = 101'325.0;
  double latitude_rad = 0.0;

  /// Writes depth, and pressure where that was measured. `out_of_range` beyond what the ocean holds.
  [[nodiscard]] std::optional<RejectReason> apply(double value, DepthSample& sample) const;
};

}  // namespace fathom::codec

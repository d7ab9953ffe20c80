#include "codec/depth/depth_line.hpp"

#include <cmath>

#include "codec/depth/pressure.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr double kMinDepth_m = -100.0;
constexpr double kMaxDepth_m = 12'000.0;
/// Below any air pressure a vehicle meets, and that of the deepest trench with room above.
constexpr double kMinPressure_Pa = 1e4;
constexpr double kMaxPressure_Pa = 1.3e8;

}  // namespace

Probe probe_depth_line(Bytes front) {
  if (is_line_end(static_cast<char>(front[0]))) return Probe::skip(1);
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (is_line_end(static_cast<char>(front[i]))) return Probe::frame(i);
    if (i == kMaxDepthLine) return Probe::bad(RejectReason::length, i, i);
  }
  return Probe::need();
}

std::optional<RejectReason> DepthScale::apply(double value, DepthSample& sample) const {
  const double quantity = value * unit + offset;
  if (value_is_depth) {
    sample.depth_m = quantity;
  } else {
    if (!(quantity >= kMinPressure_Pa && quantity <= kMaxPressure_Pa)) return RejectReason::out_of_range;
    sample.pressure_Pa = quantity;
    sample.depth_m = depth_from_pressure(quantity - atmosphere_Pa, latitude_rad);
  }
  if (!(sample.depth_m >= kMinDepth_m && sample.depth_m <= kMaxDepth_m)) return RejectReason::out_of_range;
  return std::nullopt;
}

}  // namespace fathom::codec

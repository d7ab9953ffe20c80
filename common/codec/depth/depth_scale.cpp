#include "codec/depth/depth_scale.hpp"

#include "codec/depth/pressure.hpp"

namespace fathom::codec {
namespace {

constexpr double kMinDepth_m = -100.0;
constexpr double kMaxDepth_m = 12'000.0;
/// Below any air pressure a vehicle meets, and that of the deepest trench with room above.
constexpr double kMinPressure_Pa = 1e4;
constexpr double kMaxPressure_Pa = 1.3e8;

}  // namespace

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

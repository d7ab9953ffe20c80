#include "sim/encode/depth.hpp"

#include "codec/depth/pressure.hpp"
#include "sim/encode/decimal.hpp"

namespace fathom::sim::encode {
namespace {

/// Metres of depth or pascal of absolute pressure, whichever the instrument is set to.
double quantity(const DepthSample& sample, const codec::CodecOptions& options) {
  if (options.value_is_depth) return sample.depth_m;
  if (known(sample.pressure_Pa)) return sample.pressure_Pa;
  return codec::pressure_from_depth(sample.depth_m, options.latitude_rad) + options.atmosphere_Pa;
}

}  // namespace

std::string paroscientific(const DepthSample& sample, const codec::CodecOptions& options) {
  const double unit = options.value_is_depth ? 1.0 : options.pressure_unit_Pa;
  const double value = quantity(sample, options) / unit;
  if (!known(value)) return {};
  if (!known(sample.temperature_degC)) return "*0001" + decimal(value, 5) + "\r\n";
  return "*0001P4=" + decimal(value, 5) + "," + decimal(sample.temperature_degC, 3) + "\r\n";
}

std::string ascii_depth(const DepthSample& sample, const codec::CodecOptions& options) {
  const double value = (quantity(sample, options) - options.ascii_offset) / options.ascii_scale;
  if (!known(value)) return {};
  return std::string(options.ascii_prefix) + decimal(value, 5) + "\r\n";
}

}  // namespace fathom::sim::encode

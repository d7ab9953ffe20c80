#include "codec/altimeter/valeport.hpp"

#include "base/unknown.hpp"
#include "codec/altimeter/deepest.hpp"

namespace fathom::codec {
namespace {

constexpr double kPascalPerDecibar = 1e4;
constexpr double kHighest_dbar = 13'000.0;

/// None where there is no pressure, or one that cannot be.
std::optional<DepthSample> depth_of(double pressure_dbar, const CodecOptions& options) {
  const DepthScale scale{.unit = kPascalPerDecibar,
                         .atmosphere_Pa = options.atmosphere_Pa,
                         .latitude_rad = options.latitude_rad};
  DepthSample out;
  if (!known(pressure_dbar) || scale.apply(pressure_dbar, out)) return std::nullopt;
  return out;
}

}  // namespace

std::optional<RejectReason> parse_valeport(const Sentence& sentence, const CodecOptions& options,
                                           ValeportReport& report) {
  report = {};
  if (sentence.fields != 2 && sentence.fields != 4) return RejectReason::structure;
  FieldReader range(sentence);
  report.altimeter.altitude_m = range.number(0, 0.0, kDeepestBottom_m);
  (void)range.letter(1, "M");
  if (range.refused()) report.altimeter.altitude_m = kUnknown;
  if (sentence.fields == 2) return range.refused();
  FieldReader pressure(sentence);
  const double pressure_dbar = pressure.number(2, 0.0, kHighest_dbar);
  if (pressure.text(3) != "dBar") pressure.refuse(RejectReason::field);
  if (!pressure.refused()) report.depth = depth_of(pressure_dbar, options);
  return report.depth ? std::nullopt : range.refused();
}

}  // namespace fathom::codec

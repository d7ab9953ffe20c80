#include "codec/altimeter/valeport.hpp"

#include "base/unknown.hpp"
#include "codec/altimeter/deepest.hpp"

namespace fathom::codec {
namespace {

constexpr double kHighest_dbar = 13'000.0;

}  // namespace

std::optional<RejectReason> parse_valeport(const Sentence& sentence, const DepthScale& dbar,
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
  DepthSample depth;
  if (!pressure.refused() && known(pressure_dbar) && !dbar.apply(pressure_dbar, depth)) report.depth = depth;
  return report.depth ? std::nullopt : range.refused();
}

}  // namespace fathom::codec

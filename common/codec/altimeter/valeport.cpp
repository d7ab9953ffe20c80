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
  const double number = pressure.number(2, 0.0, kHighest_dbar);
  const std::string_view unit = pressure.text(3);
  if (unit != "dBar" && unit != "Metres") pressure.refuse(RejectReason::field);
  std::optional<RejectReason> wrong = pressure.refused();
  if (!wrong && known(number) && unit == "dBar") {
    DepthSample depth;
    wrong = dbar.apply(number, depth);
    if (!wrong) report.depth = depth;
  }
  if (report.depth || known(report.altimeter.altitude_m)) return std::nullopt;
  return range.refused() ? range.refused() : wrong;
}

}  // namespace fathom::codec

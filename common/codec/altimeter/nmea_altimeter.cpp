#include "codec/altimeter/nmea_altimeter.hpp"

#include "base/units.hpp"
#include "codec/altimeter/deepest.hpp"

namespace fathom::codec {
namespace {

constexpr double kFeetPerMetre = 1.0 / kFoot_m;
constexpr double kFathomsPerMetre = kFeetPerMetre / 6.0;
constexpr double kLargestOffset_m = 1'000.0;

}  // namespace

bool is_altimeter(const Sentence& sentence) {
  return sentence.talker.size() == 2 && (sentence.type == "DPT" || sentence.type == "DBT");
}

std::optional<RejectReason> parse_altimeter(const Sentence& sentence, AltimeterSample& sample) {
  sample = AltimeterSample{};
  FieldReader fields(sentence);
  if (sentence.type == "DPT") {
    if (sentence.fields < 2 || sentence.fields > 3) return RejectReason::structure;
    sample.altitude_m = fields.number(0, 0.0, kDeepestBottom_m);
    sample.transducer_offset_m = fields.number(1, -kLargestOffset_m, kLargestOffset_m);
    (void)fields.number(2, 0.0, kDeepestBottom_m);
  } else {
    if (sentence.fields != 6) return RejectReason::structure;
    (void)fields.number(0, 0.0, kDeepestBottom_m * kFeetPerMetre);
    (void)fields.letter(1, "f");
    sample.altitude_m = fields.number(2, 0.0, kDeepestBottom_m);
    (void)fields.letter(3, "M");
    (void)fields.number(4, 0.0, kDeepestBottom_m * kFathomsPerMetre);
    (void)fields.letter(5, "F");
  }
  return fields.refused();
}

}  // namespace fathom::codec

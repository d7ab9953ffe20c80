#include "codec/heading/nmea_heading.hpp"

#include <cmath>
#include <numbers>

#include "base/units.hpp"

namespace fathom::codec {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// [0, 2 pi) from anything within one turn of it.
double wrapped(double angle_rad) {
  const double wrapped_rad = angle_rad < 0.0 ? angle_rad + kTurn : angle_rad;
  return wrapped_rad >= kTurn ? wrapped_rad - kTurn : wrapped_rad;
}

}  // namespace

double read_heading(FieldReader& fields, std::size_t index) {
  const double value_deg = fields.number(index, 0.0, 360.0);
  return value_deg == 360.0 ? 0.0 : value_deg * kRadPerDeg;
}

bool is_heading(const Sentence& sentence) {
  return sentence.talker.size() == 2 && (sentence.type == "HDT" || sentence.type == "HDM" ||
                                         sentence.type == "HDG" || sentence.type == "THS");
}

std::optional<RejectReason> parse_heading(const Sentence& sentence, HeadingSample& sample) {
  sample = HeadingSample{};
  FieldReader fields(sentence);
  if (sentence.type == "HDG") {
    if (sentence.fields != 5) return RejectReason::structure;
    sample.north = North::magnetic;
    sample.heading_rad = read_heading(fields, 0);
    sample.deviation_rad = fields.east_west(1, 180.0);
    sample.variation_rad = fields.east_west(3, 180.0);
    if (known(sample.deviation_rad)) sample.heading_rad = wrapped(sample.heading_rad + sample.deviation_rad);
  } else if (sentence.type == "THS") {
    if (sentence.fields < 1 || sentence.fields > 2) return RejectReason::structure;
    sample.heading_rad = read_heading(fields, 0);
    const char mode = fields.letter(1, "AEMSV");
    if (mode != 'A' && mode != '\0') sample.heading_rad = kUnknown;
  } else {
    if (sentence.fields != 2) return RejectReason::structure;
    const bool is_true = sentence.type == "HDT";
    sample.north = is_true ? North::true_north : North::magnetic;
    sample.heading_rad = read_heading(fields, 0);
    (void)fields.letter(1, is_true ? "T" : "M");
  }
  return fields.refused();
}

}  // namespace fathom::codec

#include "codec/acoustic/psimssb.hpp"

#include <algorithm>
#include <numbers>
#include <string_view>

namespace fathom::codec {
namespace {

constexpr double kMaxRange_m = 100'000.0;

enum Field : std::size_t {
  kUtc = 0,
  kTransponder = 1,
  kStatus = 2,
  kError = 3,
  kSystem = 4,
  kOrientation = 5,
  kFilter = 6,
  kX = 7,
  kY = 8,
  kDepth = 9,
  kAccuracy = 10,
  kAdditional = 11,
  kFirstValue = 12,
};

/// Writes the position into the sample; false where the coordinate system is one that gives no sample.
bool read_position(FieldReader& fields, UsblSample& sample) {
  const char system = fields.letter(kSystem, "CPUR");
  const char orientation = fields.letter(kOrientation, "HENG");
  if (system == 'R') {
    constexpr double kHalfTurn = std::numbers::pi;
    sample.frame = UsblFrame::geodetic;
    sample.latitude_rad = fields.number(kX, -kHalfTurn / 2.0, kHalfTurn / 2.0);
    sample.longitude_rad = fields.number(kY, -kHalfTurn, kHalfTurn);
    sample.depth_m = fields.number(kDepth, -100.0, 12'000.0);
    return true;
  }
  if (system != 'C' || orientation == 'G' || orientation == '\0') return false;
  const double x = fields.number(kX, -kMaxRange_m, kMaxRange_m);
  const double y = fields.number(kY, -kMaxRange_m, kMaxRange_m);
  const double down = fields.number(kDepth, -kMaxRange_m, kMaxRange_m);
  switch (orientation) {
    case 'H':  // x starboard, y forward
      sample.frame = UsblFrame::vessel_frd;
      sample.relative_m = {y, x, down};
      break;
    case 'N':
      sample.frame = UsblFrame::ned;
      sample.relative_m = {x, y, down};
      break;
    default:  // x east, y north
      sample.frame = UsblFrame::ned;
      sample.relative_m = {y, x, down};
      break;
  }
  return true;
}

void forget_position(UsblSample& sample) {
  sample.latitude_rad = kUnknown;
  sample.longitude_rad = kUnknown;
  sample.depth_m = kUnknown;
  sample.relative_m = {kUnknown, kUnknown, kUnknown};
  sample.sigma_m = kUnknown;
}

}  // namespace

std::optional<RejectReason> parse_psimssb(const Sentence& sentence, double sigma_floor_m, UsblSample& sample,
                                          DeviceTime& time, bool& usable) {
  sample = UsblSample{};
  time = DeviceTime{};
  usable = false;
  if (sentence.fields < 13 || sentence.fields > 14) return RejectReason::structure;
  FieldReader fields(sentence);
  time.time_of_day_ns = fields.time_of_day(kUtc);
  sample.transponder = Name(fields.text(kTransponder));
  const char status = fields.letter(kStatus, "AV");
  const bool replied = status == 'A' && fields.text(kError).empty();
  (void)fields.letter(kFilter, "MFP");
  usable = read_position(fields, sample);
  sample.sigma_m = fields.number(kAccuracy, 0.0, kMaxRange_m);
  if (known(sample.sigma_m)) sample.sigma_m = std::max(sample.sigma_m, sigma_floor_m);
  if (fields.letter(kAdditional, "NCIDTV") == 'T')
    sample.travel_time_s = fields.number(kFirstValue, 0.0, 1e3);
  if (!replied) forget_position(sample);
  return fields.refused();
}

}  // namespace fathom::codec

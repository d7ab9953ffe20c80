#include "codec/acoustic/psonlld.hpp"

#include <algorithm>
#include <cmath>

#include "base/units.hpp"

namespace fathom::codec {
namespace {

constexpr double kMaxSemiAxis_m = 100'000.0;
constexpr std::size_t kFewestFields = 10;
constexpr std::size_t kMostFields = 16;  // 13 and 14 were seen

enum LldField : std::size_t {
  kLldTime = 0,
  kLldBeacon = 1,
  kLldStatus = 2,
  kLldLatitude = 3,
  kLldLongitude = 4,
  kLldDepth = 5,
  kLldMajor = 6,
  kLldMinor = 7,
  kLldDirection = 8,
  kLldDepthSigma = 9,
};

}  // namespace

std::optional<RejectReason> parse_psonlld(const Sentence& sentence, double sigma_floor_m, UsblSample& sample,
                                          DeviceTime& time) {
  sample = UsblSample{};
  time = DeviceTime{};
  if (sentence.fields < kFewestFields || sentence.fields > kMostFields) return RejectReason::structure;
  FieldReader fields(sentence);
  time.time_of_day_ns = fields.time_of_day(kLldTime);
  sample.transponder = Name(fields.text(kLldBeacon));
  sample.frame = UsblFrame::geodetic;
  const bool located = fields.letter(kLldStatus, "AV") == 'A';
  const double latitude_deg = fields.number(kLldLatitude, -90.0, 90.0);
  const double longitude_deg = fields.number(kLldLongitude, -180.0, 180.0);
  const double depth_m = fields.number(kLldDepth, -100.0, 12'000.0);
  const double major_m = fields.number(kLldMajor, 0.0, kMaxSemiAxis_m);
  const double minor_m = fields.number(kLldMinor, 0.0, kMaxSemiAxis_m);
  (void)fields.number(kLldDirection, -360.0, 360.0);
  (void)fields.number(kLldDepthSigma, 0.0, kMaxSemiAxis_m);
  if (fields.refused() || !located) return fields.refused();
  sample.latitude_rad = latitude_deg * kRadPerDeg;
  sample.longitude_rad = longitude_deg * kRadPerDeg;
  sample.depth_m = depth_m;
  const double larger_m = std::fmax(major_m, minor_m);  // of what is known
  if (larger_m > 0.0) sample.sigma_m = std::max(larger_m, sigma_floor_m);
  return std::nullopt;
}

}  // namespace fathom::codec

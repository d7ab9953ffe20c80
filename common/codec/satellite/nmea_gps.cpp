#include "codec/satellite/nmea_gps.hpp"

#include <algorithm>
#include <string_view>

#include "base/units.hpp"
#include "codec/text/numbers.hpp"

namespace fathom::codec {
namespace {

constexpr double kMaxSpeed_kn = 20'000.0;
constexpr double kMaxAltitude_m = 1e6;
constexpr double kMaxSigma_m = 1e7;

/// Where fields stand in GGA and GNS, which share the layout up to the altitude.
constexpr std::size_t kQuality = 5;
constexpr std::size_t kSatellites = 6;
constexpr std::size_t kHdop = 7;
constexpr std::size_t kAltitude = 8;

bool fields_between(const Sentence& sentence, std::size_t low, std::size_t high) {
  return sentence.fields >= low && sentence.fields <= high;
}

void read_position(FieldReader& fields, std::size_t first, GpsReport& report) {
  report.latitude_rad = fields.latitude(first);
  report.longitude_rad = fields.longitude(first + 2);
}

void read_count_and_height(FieldReader& fields, std::size_t separation, GpsReport& report) {
  const double satellites = fields.number(kSatellites, 0.0, 999.0);
  if (known(satellites)) report.satellites = static_cast<std::int32_t>(satellites);
  report.hdop = fields.number(kHdop, 0.0, 1e4);
  report.altitude_msl_m = fields.number(kAltitude, -kMaxAltitude_m, kMaxAltitude_m);
  report.geoid_separation_m = fields.number(separation, -1000.0, 1000.0);
}

GpsFix fix_of_quality(char quality) {
  switch (quality) {
    case '1':
      return GpsFix::fix_3d;
    case '2':
    case '9':  // some receivers tell satellite-based corrections apart
      return GpsFix::differential;
    case '3':
      return GpsFix::fix_3d;
    case '4':
      return GpsFix::rtk_fixed;
    case '5':
      return GpsFix::rtk_float;
    case '6':
    case '7':
    case '8':
      return GpsFix::dead_reckoning;
    default:
      return GpsFix::none;
  }
}

/// Mode letter of RMC, VTG and GNS; `autonomous` is what A and P are worth in that sentence.
GpsFix fix_of_mode(char mode, GpsFix autonomous) {
  switch (mode) {
    case 'A':
    case 'P':
    case 'C':  // seen from Unicore receivers with a valid autonomous fix
      return autonomous;
    case 'D':
      return GpsFix::differential;
    case 'F':
      return GpsFix::rtk_float;
    case 'R':
      return GpsFix::rtk_fixed;
    case 'E':
    case 'M':
    case 'S':
      return GpsFix::dead_reckoning;
    default:
      return GpsFix::none;
  }
}

constexpr std::string_view kModes = "ACDEFMNPRS";

std::optional<TimeNs> midnight_of(int year, int month, int day, FieldReader& fields) {
  const std::optional<TimeNs> midnight = from_civil({.year = year, .month = month, .day = day});
  if (!midnight) fields.refuse(RejectReason::out_of_range);
  return midnight;
}

/// ddmmyy. The century of two digits: 80 to 99 are 19xx. A receiver whose week count has rolled over says
/// 1999; what it says is passed on.
void read_date(FieldReader& fields, std::size_t index, GpsReport& report) {
  const std::string_view text = fields.text(index);
  if (text.empty()) return;
  const std::optional<std::uint32_t> date = parse_digits(text);
  if (!date || text.size() != 6) {
    fields.refuse(RejectReason::field);
    return;
  }
  const int year = static_cast<int>(*date % 100);
  report.midnight = midnight_of(year + (year >= 80 ? 1900 : 2000), static_cast<int>(*date / 100 % 100),
                                static_cast<int>(*date / 10'000), fields);
}

bool parse_gga(const Sentence& sentence, FieldReader& fields, GpsReport& report) {
  // Some receivers leave the last field, the reference station, out together with its comma. Units where they
  // belong show that nothing else is missing.
  if (!fields_between(sentence, 13, 15)) return false;
  report.time_of_day = fields.time_of_day(0);
  read_position(fields, 1, report);
  report.fix = fix_of_quality(fields.letter(kQuality, "0123456789"));
  read_count_and_height(fields, 10, report);
  const char altitude_unit = fields.letter(9, "M");
  const char separation_unit = fields.letter(11, "M");
  return sentence.fields > 13 || (altitude_unit == 'M' && separation_unit == 'M');
}

bool parse_gns(const Sentence& sentence, FieldReader& fields, GpsReport& report) {
  if (!fields_between(sentence, 12, 13)) return false;
  report.time_of_day = fields.time_of_day(0);
  read_position(fields, 1, report);
  // One letter per constellation; the fix is what the best one gives.
  for (const char mode : fields.text(kQuality)) {
    if (kModes.find(mode) == std::string_view::npos) fields.refuse(RejectReason::field);
    report.fix = std::max(report.fix, fix_of_mode(mode, GpsFix::fix_3d));
  }
  read_count_and_height(fields, 9, report);
  return true;
}

bool parse_rmc(const Sentence& sentence, FieldReader& fields, GpsReport& report) {
  if (!fields_between(sentence, 11, 13)) return false;
  report.time_of_day = fields.time_of_day(0);
  const char status = fields.letter(1, "AV");
  read_position(fields, 2, report);
  report.speed_m_s = fields.number(6, 0.0, kMaxSpeed_kn) * kKnot_m_s;
  report.course_rad = fields.number(7, 0.0, 360.0) * kRadPerDeg;
  read_date(fields, 8, report);
  const char mode = fields.letter(11, kModes);
  // Without a mode letter status A says no more than that there is a position. The last field, navigational
  // status, says V for "not given" and is no judgement of the fix.
  if (status == 'A') report.fix = mode == '\0' ? GpsFix::fix_2d : fix_of_mode(mode, GpsFix::fix_2d);
  return true;
}

bool parse_vtg(const Sentence& sentence, FieldReader& fields, GpsReport& report) {
  if (!fields_between(sentence, 8, 9)) return false;
  report.course_rad = fields.number(0, 0.0, 360.0) * kRadPerDeg;
  const double knots = fields.number(4, 0.0, kMaxSpeed_kn);
  const double kmh = fields.number(6, 0.0, kMaxSpeed_kn / kKmh_m_s);
  (void)fields.letter(1, "T");
  (void)fields.letter(3, "M");
  (void)fields.letter(5, "N");
  (void)fields.letter(7, "K");
  report.speed_m_s = known(knots) ? knots * kKnot_m_s : kmh * kKmh_m_s;
  const char mode = fields.letter(8, kModes);
  report.fix = mode == '\0' ? GpsFix::fix_2d : fix_of_mode(mode, GpsFix::fix_2d);
  return true;
}

bool parse_gst(const Sentence& sentence, FieldReader& fields, GpsReport& report) {
  if (sentence.fields != 8) return false;
  report.time_of_day = fields.time_of_day(0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    report.sigma_N_m[axis] = fields.number(5 + axis, 0.0, kMaxSigma_m);
  }
  return true;
}

bool parse_zda(const Sentence& sentence, FieldReader& fields, GpsReport& report) {
  if (!fields_between(sentence, 4, 6)) return false;
  report.time_of_day = fields.time_of_day(0);
  const std::string_view year = fields.text(3);
  if (fields.text(1).empty() || fields.text(2).empty() || year.empty()) return true;
  const std::optional<std::uint32_t> day = parse_digits(fields.text(1));
  const std::optional<std::uint32_t> month = parse_digits(fields.text(2));
  const std::optional<std::uint32_t> parsed_year = parse_digits(year);
  if (!day || !month || !parsed_year || *day > 99 || *month > 99 || year.size() != 4) {
    fields.refuse(RejectReason::field);
    return true;
  }
  report.midnight =
      midnight_of(static_cast<int>(*parsed_year), static_cast<int>(*month), static_cast<int>(*day), fields);
  return true;
}

bool parse(GpsSentence type, const Sentence& sentence, FieldReader& fields, GpsReport& report) {
  switch (type) {
    case GpsSentence::gga:
      return parse_gga(sentence, fields, report);
    case GpsSentence::gns:
      return parse_gns(sentence, fields, report);
    case GpsSentence::rmc:
      return parse_rmc(sentence, fields, report);
    case GpsSentence::vtg:
      return parse_vtg(sentence, fields, report);
    case GpsSentence::gst:
      return parse_gst(sentence, fields, report);
    case GpsSentence::zda:
      return parse_zda(sentence, fields, report);
  }
  return false;
}

}  // namespace

std::optional<GpsSentence> gps_sentence(const Sentence& sentence) {
  constexpr std::array<std::string_view, kGpsSentences> kTypes{"GGA", "GNS", "RMC", "VTG", "GST", "ZDA"};
  const auto* found = std::find(kTypes.begin(), kTypes.end(), sentence.type);
  if (found == kTypes.end() || sentence.talker.size() != 2) return std::nullopt;
  return static_cast<GpsSentence>(found - kTypes.begin());
}

std::optional<RejectReason> parse_gps(GpsSentence type, const Sentence& sentence, GpsReport& report) {
  report = GpsReport{};
  report.type = type;
  report.talker = {sentence.talker[0], sentence.talker[1]};
  FieldReader fields(sentence);
  if (!parse(type, sentence, fields, report)) return RejectReason::structure;
  return fields.refused();
}

}  // namespace fathom::codec

#include "samples/gps.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {
namespace {

std::string_view word(GpsFix fix) {
  constexpr std::array<std::string_view, 8> kWords{"none",   "time_only",    "dead_reckoning", "fix_2d",
                                                   "fix_3d", "differential", "rtk_float",      "rtk_fixed"};
  return kWords.at(static_cast<std::size_t>(fix));
}

// Where the receiver said nothing: null, as every unknown.
Json word(GpsJamming jamming) {
  constexpr std::array kWords{"", "none", "warning", "critical"};
  return jamming == GpsJamming::unknown ? Json() : Json(kWords.at(static_cast<std::size_t>(jamming)));
}

Json word(GpsSpoofing spoofing) {
  constexpr std::array kWords{"", "none", "indicated", "affirmed"};
  return spoofing == GpsSpoofing::unknown ? Json() : Json(kWords.at(static_cast<std::size_t>(spoofing)));
}

}  // namespace

template <>
void add_fields(Json& line, const GpsSample& s) {
  line["fix"] = word(s.fix);
  line["satellites"] = s.satellites < 0 ? Json() : Json(s.satellites);
  line["hdop"] = s.hdop;
  line["lat_deg"] = degrees(s.latitude_rad);
  line["lon_deg"] = degrees(s.longitude_rad);
  line["alt_m"] = s.altitude_m;
  line["alt_msl_m"] = s.altitude_msl_m;
  constexpr std::array kAxes{'n', 'e', 'd'};
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("sigma_") + kAxes[i] + "_m"] = s.position_sigma_N_m[i];
  }
  for (std::size_t i = 0; i < 3; ++i) line[std::string{'v', kAxes[i]} + "_m_s"] = s.velocity_N_m_s[i];
  for (std::size_t i = 0; i < 3; ++i) {
    line[std::string("sigma_v") + kAxes[i] + "_m_s"] = s.velocity_sigma_N_m_s[i];
  }
  line["course_deg"] = degrees(s.course_rad);
  line["jamming"] = word(s.jamming);
  line["spoofing"] = word(s.spoofing);
}

}  // namespace fathom::cli

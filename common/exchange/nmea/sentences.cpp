#include "exchange/nmea/sentences.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "exchange/text.hpp"

namespace fathom::exchange::nmea {
namespace {

constexpr double kKnotsPerMetre = 3600.0 / 1852.0;
constexpr double kKmhPerMetre = 3.6;

std::string sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  std::array<char, 8> end{};
  std::snprintf(end.data(), end.size(), "*%02X\r\n", sum & 0xFFU);
  return "$" + body + end.data();
}

std::string from(std::string_view talker, std::string_view type) {
  return std::string(talker) + std::string(type) + ",";
}

std::string two(int value) {
  return (value < 10 ? "0" : "") + std::to_string(value);
}

// Degrees and minutes: ddmm.mmmmm. Rounded as a whole, so that minutes never read 60.
std::string angle(double degrees, int width, char positive, char negative) {
  const auto units = std::llround(std::abs(degrees) * 60.0 * 1e5);
  const long long whole = units / 6'000'000;
  std::string d = std::to_string(whole);
  d.insert(0, static_cast<std::size_t>(std::max(0, width - static_cast<int>(d.size()))), '0');
  std::string minutes = std::to_string(units % 6'000'000);
  minutes.insert(0, minutes.size() < 7 ? 7 - minutes.size() : 0, '0');
  return d + minutes.substr(0, 2) + "." + minutes.substr(2) + "," + (degrees < 0.0 ? negative : positive);
}

std::string place(const Point& p) {
  if (!known(p.latitude_deg) || !known(p.longitude_deg)) return ",,,";
  return angle(p.latitude_deg, 2, 'N', 'S') + "," +
         angle(wrapped_longitude_deg(p.longitude_deg), 3, 'E', 'W');
}

std::string maybe(double value, int count, double most = 99999.0) {
  return known(value) && std::abs(value) <= most ? decimals(value, count) : "";
}

/// Six characters and a sign at most: two decimals below a thousand, none above.
std::string short_form(double value) {
  return maybe(value, std::abs(value) < 999.995 ? 2 : 0);
}

/// [0, 360) also after rounding to `count` decimals.
std::string bearing(double degrees, int count) {
  if (!std::isfinite(degrees)) return "";
  double wrapped = std::fmod(degrees, 360.0);
  if (wrapped < 0.0) wrapped += 360.0;
  return decimals(wrapped >= 360.0 - 0.5 * std::pow(10.0, -count) ? 0.0 : wrapped, count);
}

struct Clock {
  explicit Clock(TimeNs utc_ns) {
    // To the millisecond, up to the next day where that is nearer.
    const TimeNs rounded = (utc_ns + kNsPerMillisecond / 2) / kNsPerMillisecond * kNsPerMillisecond;
    civil = to_civil(rounded);
    const auto ms = static_cast<int>(civil.nanosecond / kNsPerMillisecond);
    time = two(civil.hour) + two(civil.minute) + two(civil.second) + "." + (ms < 100 ? "0" : "") + two(ms);
    date = two(civil.day) + two(civil.month) + two(civil.year % 100);
  }
  CivilTime civil;
  std::string time;
  std::string date;
};

int quality_of(Quality quality) {
  switch (quality) {
    case Quality::none:
      return 0;
    case Quality::fix_2d:
    case Quality::fix_3d:
      return 1;
    case Quality::differential:
      return 2;
    case Quality::rtk_fixed:
      return 4;
    case Quality::rtk_float:
      return 5;
    case Quality::estimated:
      return 6;
  }
  return 6;
}

char mode_of(Quality quality) {
  switch (quality) {
    case Quality::none:
      return 'N';
    case Quality::estimated:
      return 'E';
    case Quality::differential:
    case Quality::rtk_float:
    case Quality::rtk_fixed:
      return 'D';
    default:
      return 'A';
  }
}

double ground_speed_m_s(const Point& p) {
  return std::hypot(p.velocity_N_m_s[0], p.velocity_N_m_s[1]);
}

std::string course(const Point& p) {
  return bearing(std::atan2(p.velocity_N_m_s[1], p.velocity_N_m_s[0]) * 180.0 / std::numbers::pi, 2);
}

}  // namespace

std::string gga(std::string_view talker, const Point& p) {
  // The altitude of GGA is above mean sea level and the geoid's height follows it: their sum is ours. Where
  // the sea level is not known, the sum is all in the first.
  const bool msl = known(p.altitude_msl_m) && known(p.altitude_m);
  const double above_sea_m = msl ? p.altitude_msl_m : p.altitude_m;
  const double geoid_m = msl ? p.altitude_m - p.altitude_msl_m : known(p.altitude_m) ? 0.0 : kUnknown;
  return sentence(from(talker, "GGA") + Clock(p.utc_ns).time + "," + place(p) + "," +
                  std::to_string(quality_of(p.quality)) + "," +
                  (p.satellites >= 0 ? two(std::min(p.satellites, 99)) : "") + ",," + maybe(above_sea_m, 2) +
                  ",M," + maybe(geoid_m, 2, 999.0) + ",M,,");
}

std::string rmc(std::string_view talker, const Point& p, Validity validity) {
  const Clock clock(p.utc_ns);
  return sentence(from(talker, "RMC") + clock.time + (validity == Validity::valid ? ",A," : ",V,") +
                  place(p) + "," + maybe(ground_speed_m_s(p) * kKnotsPerMetre, 3) + "," + course(p) + "," +
                  clock.date + ",,," + mode_of(p.quality));
}

std::string vtg(std::string_view talker, const Point& p) {
  const double speed_m_s = ground_speed_m_s(p);
  return sentence(from(talker, "VTG") + course(p) + ",T,,M," + maybe(speed_m_s * kKnotsPerMetre, 3) + ",N," +
                  maybe(speed_m_s * kKmhPerMetre, 3) + ",K," + mode_of(p.quality));
}

std::string gst(std::string_view talker, const Point& p) {
  return sentence(from(talker, "GST") + Clock(p.utc_ns).time + ",,,,," + maybe(p.sigma_N_m[0], 3) + "," +
                  maybe(p.sigma_N_m[1], 3) + "," + maybe(p.sigma_N_m[2], 3));
}

std::string hdt(std::string_view talker, double heading_deg) {
  return sentence(from(talker, "HDT") + bearing(heading_deg, 2) + ",T");
}

std::string zda(std::string_view talker, TimeNs utc_ns) {
  const Clock clock(utc_ns);
  return sentence(from(talker, "ZDA") + clock.time + "," + two(clock.civil.day) + "," +
                  two(clock.civil.month) + "," + std::to_string(clock.civil.year) + ",00,00");
}

std::string dpt(std::string_view talker, double below_transducer_m, double transducer_depth_m) {
  return sentence(from(talker, "DPT") + maybe(below_transducer_m, 2) + "," + maybe(transducer_depth_m, 2) +
                  ",");
}

std::string vbw(std::string_view talker, double forward_m_s, double starboard_m_s) {
  const bool valid = known(forward_m_s) && known(starboard_m_s);
  return sentence(from(talker, "VBW") + ",,V," + maybe(forward_m_s * kKnotsPerMetre, 3) + "," +
                  maybe(starboard_m_s * kKnotsPerMetre, 3) + (valid ? ",A" : ",V") + ",,V,,V");
}

std::string rot(std::string_view talker, double turn_deg_per_min) {
  return sentence(from(talker, "ROT") + maybe(turn_deg_per_min, 2) + (known(turn_deg_per_min) ? ",A" : ",V"));
}

std::string pfthm(const Uncertainty& u) {
  return sentence("PFTHM," + Clock(u.utc_ns).time + "," + u.mode + (u.aligned ? ",A," : ",V,") +
                  short_form(u.radius_95_m) + "," + short_form(u.down_sigma_m) + "," +
                  maybe(u.velocity_sigma_m_s, 3, 99.0) + "," + maybe(u.heading_sigma_deg, 3, 360.0) + "," +
                  maybe(u.tilt_sigma_deg, 3, 99.0) + "," + short_form(u.depth_m) + "," +
                  maybe(u.gps_outage_s, 0) + "," + std::to_string(u.resets % 1000U));
}

}  // namespace fathom::exchange::nmea

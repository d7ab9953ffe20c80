#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <ostream>

#include "exchange/text.hpp"
#include "exchange/track.hpp"

namespace fathom::exchange {
namespace {

constexpr double kKnotsPerMetre = 3600.0 / 1852.0;
constexpr double kKmhPerMetre = 3.6;

void sentence(std::ostream& out, const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  std::array<char, 8> end{};
  std::snprintf(end.data(), end.size(), "*%02X\r\n", sum & 0xFFU);
  out << "$" << body << end.data();
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
  return angle(p.latitude_deg, 2, 'N', 'S') + "," +
         angle(wrapped_longitude_deg(p.longitude_deg), 3, 'E', 'W');
}

std::string maybe(double value, int count, double most = 99999.0) {
  return known(value) && std::abs(value) <= most ? decimals(value, count) : "";
}

struct Clock {
  explicit Clock(TimeNs utc_ns) {
    // To the millisecond, up to the next day where that is nearer.
    const TimeNs rounded = (utc_ns + kNsPerMillisecond / 2) / kNsPerMillisecond * kNsPerMillisecond;
    const CivilTime civil = to_civil(rounded);
    const auto ms = static_cast<int>(civil.nanosecond / kNsPerMillisecond);
    time = two(civil.hour) + two(civil.minute) + two(civil.second) + "." + (ms < 100 ? "0" : "") + two(ms);
    date = two(civil.day) + two(civil.month) + two(civil.year % 100);
  }
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

void write_point(std::ostream& out, const Point& p) {
  const Clock clock(p.utc_ns);
  // The altitude of GGA is above mean sea level and the geoid's height follows it: their sum is ours. Where
  // the sea level is not known, the sum is all in the first.
  const bool msl = known(p.altitude_msl_m) && known(p.altitude_m);
  const double above_sea_m = msl ? p.altitude_msl_m : p.altitude_m;
  const double geoid_m = msl ? p.altitude_m - p.altitude_msl_m : known(p.altitude_m) ? 0.0 : kUnknown;
  sentence(out, "INGGA," + clock.time + "," + place(p) + "," + std::to_string(quality_of(p.quality)) + "," +
                    (p.satellites >= 0 ? two(std::min(p.satellites, 99)) : "") + ",," +
                    maybe(above_sea_m, 2) + ",M," + maybe(geoid_m, 2, 999.0) + ",M,,");
  const double speed_m_s = std::hypot(p.velocity_N_m_s[0], p.velocity_N_m_s[1]);
  double course_deg = std::atan2(p.velocity_N_m_s[1], p.velocity_N_m_s[0]) * 180.0 / std::numbers::pi;
  if (course_deg < 0.0) course_deg += 360.0;
  if (course_deg >= 359.995) course_deg = 0.0;
  const char mode = mode_of(p.quality);
  sentence(out, "INRMC," + clock.time + (p.quality == Quality::none ? ",V," : ",A,") + place(p) + "," +
                    maybe(speed_m_s * kKnotsPerMetre, 3) + "," + maybe(course_deg, 2) + "," + clock.date +
                    ",,," + mode);
  if (known(speed_m_s)) {
    sentence(out, "INVTG," + maybe(course_deg, 2) + ",T,,M," + maybe(speed_m_s * kKnotsPerMetre, 3) + ",N," +
                      maybe(speed_m_s * kKmhPerMetre, 3) + ",K," + mode);
  }
  if (known(p.sigma_N_m[0])) {
    sentence(out, "INGST," + clock.time + ",,,,," + maybe(p.sigma_N_m[0], 3) + "," +
                      maybe(p.sigma_N_m[1], 3) + "," + maybe(p.sigma_N_m[2], 3));
  }
  if (known(p.heading_deg))
    sentence(out, "INHDT," + decimals(p.heading_deg >= 359.995 ? 0.0 : p.heading_deg, 2) + ",T");
}

}  // namespace

void write_nmea(std::ostream& out, const Track& track) {
  for (const Point& point : track.points) write_point(out, point);
}

}  // namespace fathom::exchange

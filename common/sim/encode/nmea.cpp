#include "sim/encode/nmea.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>

#include "base/units.hpp"
#include "codec/text/nmea_sentence.hpp"
#include "geo/so3.hpp"
#include "sim/encode/decimal.hpp"

namespace fathom::sim::encode {
namespace {

constexpr double kKmhPerKnot = 1.852;

[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...) {
  std::array<char, 256> text{};
  std::va_list arguments;
  va_start(arguments, pattern);
  const int length = std::vsnprintf(text.data(), text.size(), pattern, arguments);
  va_end(arguments);
  return {text.data(), std::min(static_cast<std::size_t>(std::max(length, 0)), text.size() - 1)};
}

CivilTime civil_to_millisecond(TimeNs utc_ns) {
  return to_civil((utc_ns + kNsPerMillisecond / 2) / kNsPerMillisecond * kNsPerMillisecond);
}

std::string time_text(const CivilTime& t) {
  return format("%02d%02d%02d.%03d", t.hour, t.minute, t.second,
                static_cast<int>(t.nanosecond / kNsPerMillisecond));
}

/// Degrees and minutes of 1e-7 minute, counted in whole units so that rounding never gives 60 minutes.
std::string angle_text(double angle_rad, int degree_digits, std::string_view hemispheres) {
  if (!known(angle_rad)) return ",";
  constexpr std::int64_t kUnitsPerMinute = 10'000'000;
  const std::int64_t units =
      std::llround(std::abs(angle_rad) * kDegPerRad * 60.0 * static_cast<double>(kUnitsPerMinute));
  const std::int64_t minutes = units / kUnitsPerMinute;
  return format("%0*d%02d.%07d,%c", degree_digits, static_cast<int>(minutes / 60),
                static_cast<int>(minutes % 60), static_cast<int>(units % kUnitsPerMinute),
                angle_rad < 0.0 ? hemispheres[1] : hemispheres[0]);
}

std::string position_text(const GpsSample& sample) {
  return angle_text(sample.latitude_rad, 2, "NS") + "," + angle_text(sample.longitude_rad, 3, "EW");
}

char quality_of(GpsFix fix) {
  switch (fix) {
    case GpsFix::none:
    case GpsFix::time_only:
      return '0';
    case GpsFix::dead_reckoning:
      return '6';
    case GpsFix::fix_2d:
    case GpsFix::fix_3d:
      return '1';
    case GpsFix::differential:
      return '2';
    case GpsFix::rtk_float:
      return '5';
    case GpsFix::rtk_fixed:
      return '4';
  }
  return '0';
}

char mode_of(GpsFix fix) {
  switch (fix) {
    case GpsFix::none:
    case GpsFix::time_only:
      return 'N';
    case GpsFix::dead_reckoning:
      return 'E';
    case GpsFix::fix_2d:
    case GpsFix::fix_3d:
      return 'A';
    case GpsFix::differential:
      return 'D';
    case GpsFix::rtk_float:
      return 'F';
    case GpsFix::rtk_fixed:
      return 'R';
  }
  return 'N';
}

/// East positive angle and its letter.
std::string east_west_text(double angle_rad) {
  if (!known(angle_rad)) return ",";
  return format("%.3f,%c", std::abs(angle_rad) * kDegPerRad, angle_rad < 0.0 ? 'W' : 'E');
}

double turn_deg(double angle_rad) {
  const double angle_deg = std::fmod(angle_rad * kDegPerRad, 360.0);
  return angle_deg < 0.0 ? angle_deg + 360.0 : angle_deg;
}

/// What a topside sends of its ship beside the fixes: GGA of the place, HDT of the heading, as far as known.
std::string ship_pose(const UsblSample& sample, TimeNs utc_ns) {
  std::string out;
  if (known(sample.station_latitude_rad) && known(sample.station_longitude_rad)) {
    out += nmea_sentence("GPGGA," + time_text(civil_to_millisecond(utc_ns)) + "," +
                         angle_text(sample.station_latitude_rad, 2, "NS") + "," +
                         angle_text(sample.station_longitude_rad, 3, "EW") + ",1,10,1.0,0.0,M,0.0,M,,");
  }
  if (known(sample.station_rpy_rad[2])) {
    out += nmea_sentence("HEHDT," + decimal(turn_deg(sample.station_rpy_rad[2]), 3) + ",T");
  }
  return out;
}

/// Components of a fix in the levelled axes that PSIMSSB has for a vessel.
std::array<double, 3> levelled(const UsblSample& sample) {
  const auto& rpy = sample.station_rpy_rad;
  if (sample.frame != UsblFrame::vessel_frd || !known(rpy[0]) || !known(rpy[1])) return sample.relative_m;
  return geo::arr(geo::to_matrix(geo::from_rpy({rpy[0], rpy[1], 0.0})) * geo::vec(sample.relative_m));
}

}  // namespace

std::string nmea_sentence(std::string_view body) {
  return "$" + std::string(body) + format("*%02X\r\n", codec::nmea_checksum(body));
}

std::string nmea_gps(const GpsSample& sample, TimeNs utc_ns, std::string_view talker) {
  GpsSample sent = sample;
  const bool fixed = sample.fix >= GpsFix::dead_reckoning;
  if (!fixed) sent = GpsSample{.header = {}, .satellites = sample.satellites, .hdop = sample.hdop};
  if (sample.fix == GpsFix::fix_2d) sent.altitude_m = sent.altitude_msl_m = kUnknown;

  const CivilTime civil = civil_to_millisecond(utc_ns);
  const std::string time = time_text(civil);
  const std::string position = position_text(sent);
  const std::string name(talker);
  const bool has_msl = known(sent.altitude_msl_m);
  const double altitude_msl_m = has_msl ? sent.altitude_msl_m : sent.altitude_m;
  const double separation_m =
      has_msl ? sent.altitude_m - sent.altitude_msl_m : (known(altitude_msl_m) ? 0.0 : kUnknown);
  const double speed_kn = std::hypot(sent.velocity_N_m_s[0], sent.velocity_N_m_s[1]) / kKnot_m_s;
  const double course_deg = turn_deg(std::atan2(sent.velocity_N_m_s[1], sent.velocity_N_m_s[0]));
  const char mode = mode_of(sample.fix);

  const std::string satellites = sent.satellites >= 0 ? format("%02d", sent.satellites) : std::string();
  std::string out = nmea_sentence(name + "GGA," + time + "," + position + "," + quality_of(sample.fix) + "," +
                                  satellites + "," + decimal(sent.hdop, 2) + "," +
                                  decimal(altitude_msl_m, 3) + ",M," + decimal(separation_m, 3) + ",M,,");
  out += nmea_sentence(name + "RMC," + time + (fixed ? ",A," : ",V,") + position + "," +
                       decimal(speed_kn, 4) + "," + decimal(course_deg, 3) + "," +
                       format("%02d%02d%02d", civil.day, civil.month, civil.year % 100) + ",,," + mode);
  out += nmea_sentence(name + "VTG," + decimal(course_deg, 3) + ",T,,M," + decimal(speed_kn, 4) + ",N," +
                       decimal(speed_kn * kKmhPerKnot, 4) + ",K," + mode);
  out += nmea_sentence(name + "GST," + time + ",,,,," + decimal(sent.position_sigma_N_m[0], 3) + "," +
                       decimal(sent.position_sigma_N_m[1], 3) + "," + decimal(sent.position_sigma_N_m[2], 3));
  return out;
}

std::string nmea_heading(const HeadingSample& sample, std::string_view talker) {
  const std::string name(talker);
  if (sample.north == North::true_north) {
    return nmea_sentence(name + "HDT," + decimal(turn_deg(sample.heading_rad), 3) + ",T");
  }
  const double deviation_rad = known(sample.deviation_rad) ? sample.deviation_rad : 0.0;
  return nmea_sentence(name + "HDG," + decimal(turn_deg(sample.heading_rad - deviation_rad), 3) + "," +
                       east_west_text(sample.deviation_rad) + "," + east_west_text(sample.variation_rad));
}

std::string nmea_attitude(const HeadingSample& sample, TimeNs utc_ns) {
  const std::string heading = decimal(turn_deg(sample.heading_rad), 3);
  if (sample.north == North::magnetic) return nmea_sentence("OHPR," + heading + ",,,");
  const std::string sigma = decimal(sample.sigma_rad * kDegPerRad, 3);
  return nmea_sentence("PASHR," + time_text(civil_to_millisecond(utc_ns)) + "," + heading + ",T,,,,,," +
                       sigma + (known(sample.heading_rad) ? ",2,1" : ",0,0"));
}

std::string nmea_rpm(const PropulsionSample& sample, std::string_view talker) {
  return nmea_sentence(std::string(talker) + "RPM,S,1," + decimal(sample.rpm, 2) + ",," +
                       (known(sample.rpm) ? 'A' : 'V'));
}

std::string nmea_fins(const FinsSample& sample, std::string_view talker) {
  const std::string name(talker);
  const double bow_to_starboard_deg = -sample.rudder_rad * kDegPerRad;
  return nmea_sentence(name + "RSA," + decimal(bow_to_starboard_deg, 3) + "," +
                       (known(sample.rudder_rad) ? 'A' : 'V') + ",,V") +
         nmea_sentence(name + "XDR,A," + decimal(sample.stern_rad * kDegPerRad, 3) + ",D,STERN");
}

std::string psimssb(const UsblSample& sample, TimeNs utc_ns) {
  const bool geodetic = sample.frame == UsblFrame::geodetic;
  const std::array<double, 3> r = levelled(sample);
  const bool replied = geodetic ? known(sample.latitude_rad) && known(sample.longitude_rad)
                                : known(r[0]) && known(r[1]) && known(r[2]);
  std::string position = ",,";
  if (replied && geodetic) {
    position = decimal(sample.latitude_rad, 10) + "," + decimal(sample.longitude_rad, 10) + "," +
               decimal(sample.depth_m, 3);
  } else if (replied) {
    const bool vessel = sample.frame == UsblFrame::vessel_frd;
    position =
        decimal(vessel ? r[1] : r[0], 3) + "," + decimal(vessel ? r[0] : r[1], 3) + "," + decimal(r[2], 3);
  }
  const char* axes = geodetic ? "R,G" : sample.frame == UsblFrame::vessel_frd ? "C,H" : "C,N";
  return ship_pose(sample, utc_ns) +
         nmea_sentence("PSIMSSB," + time_text(civil_to_millisecond(utc_ns)) + "," + sample.transponder.str() +
                       (replied ? ",A,," : ",V,NRy,") + axes + ",M," + position + "," +
                       decimal(replied ? sample.sigma_m : kUnknown, 3) + ",T," +
                       decimal(sample.travel_time_s, 6) + ",");
}

std::string psonlld(const UsblSample& sample, TimeNs utc_ns) {
  const bool located = sample.frame == UsblFrame::geodetic && known(sample.latitude_rad) &&
                       known(sample.longitude_rad) && known(sample.depth_m);
  std::string position = ",,";
  std::string semi_axes = ",";
  if (located) {
    position = decimal(sample.latitude_rad * kDegPerRad, 9) + "," +
               decimal(sample.longitude_rad * kDegPerRad, 9) + "," + decimal(sample.depth_m, 3);
    semi_axes = decimal(sample.sigma_m, 3) + "," + decimal(sample.sigma_m, 3);
  }
  return nmea_sentence("PSONLLD," + time_text(civil_to_millisecond(utc_ns)) + "," + sample.transponder.str() +
                       (located ? ",A," : ",V,") + position + "," + semi_axes + ",0.00,,,,,");
}

}  // namespace fathom::sim::encode

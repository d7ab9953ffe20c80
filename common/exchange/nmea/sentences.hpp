#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "exchange/track.hpp"

/// Sentences of NMEA 0183 for chart plotters, autopilots and loggers. Each ends with checksum and CR LF and
/// has 82 characters at most; what is unknown or does not fit is an empty field. `talker` is of two
/// characters.
namespace fathom::exchange::nmea {

/// Whether who reads a position may use it: not, where there is none, nor where it is less certain than was
/// agreed.
enum class Validity : std::uint8_t { valid, not_valid };

/// Position, altitude, fix quality: 6 where it is estimated, 0 without position where there is none.
[[nodiscard]] std::string gga(std::string_view talker, const Point& point);
/// Position, speed and course over ground, date. The status is A only where the position is valid; then its
/// mode may still be E, estimated.
[[nodiscard]] std::string rmc(std::string_view talker, const Point& point, Validity validity);
/// Course and speed over ground.
[[nodiscard]] std::string vtg(std::string_view talker, const Point& point);
/// One sigma of latitude, longitude and altitude, in m.
[[nodiscard]] std::string gst(std::string_view talker, const Point& point);
/// True heading.
[[nodiscard]] std::string hdt(std::string_view talker, double heading_deg);
/// UTC; no local zone.
[[nodiscard]] std::string zda(std::string_view talker, TimeNs utc_ns);
/// Water below a transducer, and how deep under the surface the transducer is: their sum is the water's
/// depth.
[[nodiscard]] std::string dpt(std::string_view talker, double below_transducer_m, double transducer_depth_m);
/// Speed over ground along and across the vehicle, forward and to starboard. Speed through the water is not
/// known.
[[nodiscard]] std::string vbw(std::string_view talker, double forward_m_s, double starboard_m_s);
/// Rate of turn of the heading, to starboard positive.
[[nodiscard]] std::string rot(std::string_view talker, double turn_deg_per_min);

/// What only we say. See pfthm().
struct Uncertainty {
  TimeNs utc_ns = 0;
  char mode = 'N';  ///< N none, L aligning, G satellites, A acoustic, D dead reckoning, I inertial alone
  bool aligned = false;
  double radius_95_m = kUnknown;  ///< that holds the horizontal position with 95 % probability
  double down_sigma_m = kUnknown;
  double velocity_sigma_m_s = kUnknown;  ///< horizontal, the larger axis
  double heading_sigma_deg = kUnknown;
  double tilt_sigma_deg = kUnknown;  ///< of roll and pitch, the larger one
  double depth_m = kUnknown;         ///< of the vehicle
  double gps_outage_s = kUnknown;
  unsigned resets = 0;  ///< steps of the position that are not motion, modulo 1000
};
/// $PFTHM,time,mode,A|V aligned or not,95 % radius m,sigma down m,sigma velocity m/s,sigma heading deg,sigma
/// tilt deg,depth m,s since GPS was used,count of steps of the position.
[[nodiscard]] std::string pfthm(const Uncertainty& u);

}  // namespace fathom::exchange::nmea

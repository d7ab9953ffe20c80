#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "base/unknown.hpp"

/// Tracks for the programs of others: maps, chart plotters, loggers.
namespace fathom::exchange {

enum class Quality : std::uint8_t { none, fix_2d, fix_3d, differential, rtk_float, rtk_fixed, estimated };

struct Point {
  TimeNs utc_ns = 0;
  double latitude_deg = kUnknown;   ///< +-90
  double longitude_deg = kUnknown;  ///< [-180, 180)
  double altitude_m = kUnknown;     ///< above the WGS-84 ellipsoid
  double altitude_msl_m = kUnknown;
  std::array<double, 3> velocity_N_m_s{kUnknown, kUnknown, kUnknown};
  double heading_deg = kUnknown;  ///< [0, 360), from true north
  std::array<double, 3> sigma_N_m{kUnknown, kUnknown, kUnknown};
  Quality quality = Quality::estimated;
  int satellites = -1;
};

/// In the order of time. Every point has a latitude and a longitude.
struct Track {
  std::string name;
  std::vector<Point> points;
};

/// [-180, 180).
[[nodiscard]] double wrapped_longitude_deg(double longitude_deg);

/// Index ranges [begin, end) between which there are more than `longest_gap_s`.
struct Stretch {
  std::size_t begin = 0;
  std::size_t end = 0;
};
[[nodiscard]] std::vector<Stretch> stretches(const Track& track, double longest_gap_s = 10.0);

struct Place {
  double longitude_deg = 0.0;
  double latitude_deg = 0.0;
  double altitude_m = kUnknown;
};
using Line = std::vector<Place>;
/// A track as lines: parted at gaps and where it passes the antimeridian, which both parts then touch.
[[nodiscard]] std::vector<Line> lines_of(const Track& track);

/// KML 2.2: a line of each track, cut as above, its first and last place. lon,lat,alt; altitude above the
/// ellipsoid.
void write_kml(std::ostream& out, const std::string& title, const std::vector<Track>& tracks);
/// GPX 1.1: a trk of each track, a trkseg between gaps.
void write_gpx(std::ostream& out, const std::string& title, const std::vector<Track>& tracks);
/// RFC 7946: a feature of each track, cut where it passes the antimeridian and at gaps.
void write_geojson(std::ostream& out, const std::vector<Track>& tracks);
/// NMEA 0183: GGA, RMC, VTG, GST, HDT of each point, as far as it knows them. Talker IN. Every sentence has
/// its checksum and 82 characters at most.
void write_nmea(std::ostream& out, const Track& track);

}  // namespace fathom::exchange

#include <cmath>
#include <ostream>
#include <string_view>

#include "exchange/text.hpp"
#include "exchange/track.hpp"

namespace fathom::exchange {
namespace {

std::string_view fix_of(Quality quality) {
  switch (quality) {
    case Quality::none:
      return "none";
    case Quality::fix_2d:
      return "2d";
    case Quality::fix_3d:
      return "3d";
    case Quality::differential:
    case Quality::rtk_float:
    case Quality::rtk_fixed:
      return "dgps";
    case Quality::estimated:
      return {};  // the schema has no word for it
  }
  return {};
}

// The schema fixes the order of the elements, and a longitude is below 180: also when it has been rounded.
void write_waypoint(std::ostream& out, const Point& p) {
  out << "<trkpt lat=\"" << decimals(p.latitude_deg, 9) << "\" lon=\""
      << decimals(wrapped_longitude_deg(std::round(p.longitude_deg * 1e9) / 1e9), 9) << "\">";
  if (known(p.altitude_m)) out << "<ele>" << decimals(p.altitude_m, 3) << "</ele>";
  out << "<time>" << to_iso8601(p.utc_ns, 3) << "</time>";
  if (const std::string_view fix = fix_of(p.quality); !fix.empty()) out << "<fix>" << fix << "</fix>";
  if (p.satellites >= 0) out << "<sat>" << p.satellites << "</sat>";
  out << "</trkpt>\n";
}

}  // namespace

void write_gpx(std::ostream& out, const std::string& title, const std::vector<Track>& tracks) {
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      << "<gpx version=\"1.1\" creator=\"fathom\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
      << "<metadata><name>" << plain(title)
      << "</name><desc>elevations are above the WGS-84 ellipsoid</desc></metadata>\n";
  for (const Track& track : tracks) {
    out << "<trk><name>" << plain(track.name) << "</name>\n";
    for (const Stretch& stretch : stretches(track)) {
      out << "<trkseg>\n";
      for (std::size_t i = stretch.begin; i < stretch.end; ++i) write_waypoint(out, track.points[i]);
      out << "</trkseg>\n";
    }
    out << "</trk>\n";
  }
  out << "</gpx>\n";
}

}  // namespace fathom::exchange

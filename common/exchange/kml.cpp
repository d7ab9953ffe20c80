#include <array>
#include <ostream>

#include "exchange/text.hpp"
#include "exchange/track.hpp"

namespace fathom::exchange {
namespace {

// aabbggrr
constexpr std::array<const char*, 4> kColours{"ff2f6fe0", "ffb06020", "ff40a040", "ff9040a0"};

std::string place(const Place& p) {
  return decimals(p.longitude_deg, 9) + "," + decimals(p.latitude_deg, 9) +
         (known(p.altitude_m) ? "," + decimals(p.altitude_m, 3) : "");
}

void placemark(std::ostream& out, const std::string& name, const Point& point) {
  out << "<Placemark><name>" << plain(name) << "</name><TimeStamp><when>" << to_iso8601(point.utc_ns, 3)
      << "</when></TimeStamp><Point><altitudeMode>absolute</altitudeMode><coordinates>"
      << place({point.longitude_deg, point.latitude_deg, point.altitude_m})
      << "</coordinates></Point></Placemark>\n";
}

}  // namespace

void write_kml(std::ostream& out, const std::string& title, const std::vector<Track>& tracks) {
  out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n"
      << "<Document><name>" << plain(title)
      << "</name><description>fathom; altitudes are above the WGS-84 ellipsoid</description>\n";
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    out << "<Style id=\"track" << i << "\"><LineStyle><color>" << kColours[i % kColours.size()]
        << "</color><width>2</width></LineStyle></Style>\n";
  }
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const Track& track = tracks[i];
    if (track.points.empty()) continue;
    out << "<Folder><name>" << plain(track.name) << "</name>\n";
    for (const Line& line : lines_of(track)) {
      if (line.size() < 2) continue;
      out << "<Placemark><name>" << plain(track.name) << "</name><TimeSpan><begin>"
          << to_iso8601(track.points.front().utc_ns, 3) << "</begin><end>"
          << to_iso8601(track.points.back().utc_ns, 3) << "</end></TimeSpan><styleUrl>#track" << i
          << "</styleUrl><LineString><altitudeMode>absolute</altitudeMode><coordinates>\n";
      for (const Place& p : line) out << place(p) << "\n";
      out << "</coordinates></LineString></Placemark>\n";
    }
    placemark(out, track.name + ": begin", track.points.front());
    placemark(out, track.name + ": end", track.points.back());
    out << "</Folder>\n";
  }
  out << "</Document>\n</kml>\n";
}

}  // namespace fathom::exchange

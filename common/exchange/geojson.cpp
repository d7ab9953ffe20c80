#include <ostream>

#include "exchange/text.hpp"
#include "exchange/track.hpp"

namespace fathom::exchange {
namespace {

void write_place(std::ostream& out, const Place& p) {
  out << "[" << decimals(p.longitude_deg, 9) << "," << decimals(p.latitude_deg, 9);
  if (known(p.altitude_m)) out << "," << decimals(p.altitude_m, 3);
  out << "]";
}

void write_line(std::ostream& out, const Line& line) {
  out << "[";
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (i > 0) out << ",";
    write_place(out, line[i]);
  }
  out << "]";
}

void write_geometry(std::ostream& out, const std::vector<Line>& all) {
  // A line has two places at least; a lone place between gaps is a point.
  std::vector<Line> lines;
  Line alone;
  for (const Line& line : all) {
    if (line.size() > 1) {
      lines.push_back(line);
    } else {
      alone.insert(alone.end(), line.begin(), line.end());
    }
  }
  const bool both = !lines.empty() && !alone.empty();
  if (both) out << R"({"type":"GeometryCollection","geometries":[)";
  if (!lines.empty()) {
    out << R"({"type":"MultiLineString","coordinates":[)";
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (i > 0) out << ",\n";
      write_line(out, lines[i]);
    }
    out << "]}";
  }
  if (both) out << ",";
  if (!alone.empty()) {
    out << R"({"type":"MultiPoint","coordinates":)";
    write_line(out, alone);
    out << "}";
  }
  if (both) out << "]}";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E ? '?' : c;
  }
  return out + "\"";
}

}  // namespace

void write_geojson(std::ostream& out, const std::vector<Track>& tracks) {
  out << R"({"type":"FeatureCollection","features":[)";
  bool first = true;
  for (const Track& track : tracks) {
    if (track.points.empty()) continue;
    out << (first ? "\n" : ",\n") << R"({"type":"Feature","properties":{"name":)" << quoted(track.name)
        << R"(,"begin":")" << to_iso8601(track.points.front().utc_ns, 3) << R"(","end":")"
        << to_iso8601(track.points.back().utc_ns, 3) << R"("},"geometry":)";
    write_geometry(out, lines_of(track));
    out << "}";
    first = false;
  }
  out << "\n]}\n";
}

}  // namespace fathom::exchange

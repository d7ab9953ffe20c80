#include "exchange/track.hpp"

#include <cmath>

namespace fathom::exchange {
namespace {

// Where the way from a to b meets the antimeridian, on the side of a.
Place at_antimeridian(const Place& a, const Place& b) {
  const double side = a.longitude_deg < 0.0 ? -180.0 : 180.0;
  const double b_beside_a = b.longitude_deg + 2.0 * side;
  const double part = (side - a.longitude_deg) / (b_beside_a - a.longitude_deg);
  return {side, a.latitude_deg + part * (b.latitude_deg - a.latitude_deg),
          a.altitude_m + part * (b.altitude_m - a.altitude_m)};
}

}  // namespace

double wrapped_longitude_deg(double longitude_deg) {
  double wrapped = std::fmod(longitude_deg + 180.0, 360.0);
  if (wrapped < 0.0) wrapped += 360.0;
  wrapped -= 180.0;
  return wrapped < 180.0 ? wrapped : -180.0;
}

std::vector<Stretch> stretches(const Track& track, double longest_gap_s) {
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    const bool begins =
        i == 0 || to_seconds(track.points[i].utc_ns - track.points[i - 1].utc_ns) > longest_gap_s;
    if (begins) out.push_back({i, i});
    out.back().end = i + 1;
  }
  return out;
}

std::vector<Line> lines_of(const Track& track) {
  std::vector<Line> lines;
  for (const Stretch& stretch : stretches(track)) {
    lines.emplace_back();
    for (std::size_t i = stretch.begin; i < stretch.end; ++i) {
      const Point& p = track.points[i];
      const Place place{wrapped_longitude_deg(p.longitude_deg), p.latitude_deg, p.altitude_m};
      if (!lines.back().empty() &&
          std::abs(place.longitude_deg - lines.back().back().longitude_deg) > 180.0) {
        Place edge = at_antimeridian(lines.back().back(), place);
        lines.back().push_back(edge);
        edge.longitude_deg = -edge.longitude_deg;
        lines.push_back({edge});
      }
      lines.back().push_back(place);
    }
  }
  return lines;
}

}  // namespace fathom::exchange

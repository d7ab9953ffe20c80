#include "samples/usbl.hpp"

#include "cli/decode/fields.hpp"

namespace fathom::cli {
namespace {

std::string_view word(UsblFrame frame) {
  constexpr std::array<std::string_view, 4> kWords{"geodetic", "ned", "vessel_frd", "vehicle_frd"};
  return kWords.at(static_cast<std::size_t>(frame));
}

}  // namespace

template <>
void add_fields(Json& line, const UsblSample& s) {
  line["transponder"] = s.transponder.view();
  line["frame"] = word(s.frame);
  line["lat_deg"] = degrees(s.latitude_rad);
  line["lon_deg"] = degrees(s.longitude_rad);
  line["depth_m"] = s.depth_m;
  constexpr std::array<std::array<const char*, 3>, 4> kKeys{{{"x_m", "y_m", "z_m"},
                                                             {"north_m", "east_m", "down_m"},
                                                             {"forward_m", "right_m", "down_m"},
                                                             {"forward_m", "right_m", "down_m"}}};
  if (s.frame != UsblFrame::geodetic) {
    const auto& keys = kKeys.at(static_cast<std::size_t>(s.frame));
    for (std::size_t i = 0; i < 3; ++i) line[keys[i]] = s.relative_m[i];
    line["range_m"] = s.range_m;
    line["bearing_deg"] = degrees(s.bearing_rad);
    line["depression_deg"] = degrees(s.depression_rad);
    line["sigma_deg"] = degrees(s.sigma_rad);
    line["station_lat_deg"] = degrees(s.station_latitude_rad);
    line["station_lon_deg"] = degrees(s.station_longitude_rad);
    line["station_depth_m"] = s.station_depth_m;
    line["station_yaw_deg"] = degrees(s.station_rpy_rad[2]);
  }
  line["sigma_m"] = s.sigma_m;
  line["travel_time_s"] = s.travel_time_s;
}

}  // namespace fathom::cli

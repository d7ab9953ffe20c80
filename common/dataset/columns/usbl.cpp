#include "samples/usbl.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {
namespace {

// Either a place or a path from a station: columns of the other are not looked at.
void keep_what_the_frame_has(const CsvReader& csv, UsblSample& s) {
  UsblSample kept;
  kept.header = s.header;
  kept.frame = s.frame;
  kept.sigma_m = s.sigma_m;
  if (s.frame == UsblFrame::geodetic) {
    for (const char* name : {"lat_deg", "lon_deg", "depth_m"}) {
      if (!csv.optional_column(name))
        csv.fail("column frame: geodetic, expected the columns lat_deg, lon_deg and depth_m");
    }
    kept.latitude_rad = s.latitude_rad;
    kept.longitude_rad = s.longitude_rad;
    kept.depth_m = s.depth_m;
    s = kept;
  } else {
    s.latitude_rad = s.longitude_rad = s.depth_m = kept.depth_m;
  }
}

}  // namespace

template <>
const Columns<UsblSample>& columns() {
  static const auto kColumns = [] {
    Columns<UsblSample> c;
    c.place(&UsblSample::latitude_rad, &UsblSample::longitude_rad);
    c.number("depth_m", &UsblSample::depth_m);
    c.required_without("frame");
    c.number("sigma_m", &UsblSample::sigma_m);
    c.optional([](const UsblSample& s) { return s.frame != UsblFrame::geodetic; });
    c.word<UsblFrame>("frame", &UsblSample::frame,
                      {{"geodetic", UsblFrame::geodetic},
                       {"ned", UsblFrame::ned},
                       {"vessel", UsblFrame::vessel_frd},
                       {"vehicle", UsblFrame::vehicle_frd}});
    c.numbers<3>({"x_m", "y_m", "z_m"}, &UsblSample::relative_m);
    c.number("range_m", &UsblSample::range_m);
    c.degrees("bearing_deg", &UsblSample::bearing_rad);
    c.degrees("depression_deg", &UsblSample::depression_rad);
    c.degrees("sigma_deg", &UsblSample::sigma_rad);
    c.degrees("station_lat_deg", &UsblSample::station_latitude_rad);
    c.degrees("station_lon_deg", &UsblSample::station_longitude_rad);
    c.number("station_depth_m", &UsblSample::station_depth_m);
    c.degrees<3>({"station_roll_deg", "station_pitch_deg", "station_yaw_deg"}, &UsblSample::station_rpy_rad);
    c.finally(keep_what_the_frame_has);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

#include "samples/range.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {

template <>
const Columns<RangeSample>& columns() {
  static const auto kColumns = [] {
    Columns<RangeSample> c;
    c.number("range_m", &RangeSample::range_m);
    c.number("sigma_m", &RangeSample::sigma_m);
    c.degrees("beacon_lat_deg", &RangeSample::beacon_latitude_rad);
    c.degrees("beacon_lon_deg", &RangeSample::beacon_longitude_rad);
    c.number("beacon_depth_m", &RangeSample::beacon_depth_m);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

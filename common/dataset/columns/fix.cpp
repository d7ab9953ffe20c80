#include "samples/position/fix.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {

template <>
const Columns<FixSample>& columns() {
  static const auto kColumns = [] {
    Columns<FixSample> c;
    c.place(&FixSample::latitude_rad, &FixSample::longitude_rad);
    c.number("sigma_m", &FixSample::sigma_m);
    c.optional([](const FixSample& s) { return known(s.depth_m); });
    c.number("depth_m", &FixSample::depth_m);
    c.optional([](const FixSample& s) { return known(s.depth_sigma_m); });
    c.number("depth_sigma_m", &FixSample::depth_sigma_m);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

#include "samples/depth.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {

template <>
const Columns<DepthSample>& columns() {
  static const auto kColumns = [] {
    Columns<DepthSample> c;
    c.number("depth_m", &DepthSample::depth_m);
    c.optional([](const DepthSample& s) { return known(s.sigma_m); });
    c.number("sigma_m", &DepthSample::sigma_m);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

#include "samples/heading.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {

template <>
const Columns<HeadingSample>& columns() {
  static const auto kColumns = [] {
    Columns<HeadingSample> c;
    c.degrees("heading_deg", &HeadingSample::heading_rad);
    c.optional([](const HeadingSample& s) { return known(s.sigma_rad); });
    c.degrees("sigma_deg", &HeadingSample::sigma_rad);
    c.optional([](const HeadingSample& s) { return s.north == North::magnetic; });
    c.word<North>("north", &HeadingSample::north,
                  {{"true", North::true_north}, {"magnetic", North::magnetic}});
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

#include "samples/altimeter.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {

template <>
const Columns<AltimeterSample>& columns() {
  static const auto kColumns = [] {
    Columns<AltimeterSample> c;
    c.number("altitude_m", &AltimeterSample::altitude_m);
    c.optional([](const AltimeterSample& s) { return known(s.sigma_m); });
    c.number("sigma_m", &AltimeterSample::sigma_m);
    c.optional([](const AltimeterSample& s) { return s.vertical; });
    c.word<bool>("along", &AltimeterSample::vertical, {{"axis", false}, {"vertical", true}});
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

#include "dataset/columns.hpp"
#include "samples/actuator.hpp"

namespace fathom::dataset {

template <>
const Columns<FinsSample>& columns() {
  static const auto kColumns = [] {
    Columns<FinsSample> c;
    c.number("rudder_rad", &FinsSample::rudder_rad);
    c.number("stern_rad", &FinsSample::stern_rad);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

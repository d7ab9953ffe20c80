#include "dataset/columns.hpp"
#include "samples/actuator.hpp"

namespace fathom::dataset {

template <>
const Columns<PropulsionSample>& columns() {
  static const auto kColumns = [] {
    Columns<PropulsionSample> c;
    c.number("rpm", &PropulsionSample::rpm);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

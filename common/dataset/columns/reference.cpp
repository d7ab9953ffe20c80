#include "dataset/columns.hpp"
#include "samples/truth.hpp"

namespace fathom::dataset {

template <>
const Columns<Truth>& columns() {
  static const auto kColumns = [] {
    Columns<Truth> c;
    c.place(&Truth::latitude_rad, &Truth::longitude_rad);
    c.number("alt_m", &Truth::altitude_m);
    c.numbers<3>({"vn_m_s", "ve_m_s", "vd_m_s"}, &Truth::velocity_N_m_s);
    c.degrees<3>({"roll_deg", "pitch_deg", "yaw_deg"}, &Truth::rpy_rad);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

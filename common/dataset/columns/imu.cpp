#include "samples/imu.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {

template <>
const Columns<ImuSample>& columns() {
  static const auto kColumns = [] {
    Columns<ImuSample> c;
    c.numbers<3>({"gx_rad_s", "gy_rad_s", "gz_rad_s"}, &ImuSample::angular_rate_B_rad_s);
    c.numbers<3>({"ax_m_s2", "ay_m_s2", "az_m_s2"}, &ImuSample::specific_force_B_m_s2);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

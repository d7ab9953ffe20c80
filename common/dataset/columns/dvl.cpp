#include "samples/dvl.hpp"

#include <algorithm>

#include "dataset/columns.hpp"

namespace fathom::dataset {
namespace {

void read_valid(const CsvReader& csv, CsvReader::Column column, DvlSample& s) {
  const double valid = csv.number(column);
  if (known(valid) && valid != 0.0 && valid != 1.0)
    csv.fail("column valid: '" + std::string(csv.text(column)) + "', expected 0 or 1");
  if (valid == 0.0) s.velocity_D_m_s.fill(kUnknown);
}

}  // namespace

template <>
const Columns<DvlSample>& columns() {
  static const auto kColumns = [] {
    Columns<DvlSample> c;
    c.numbers<3>({"vx_m_s", "vy_m_s", "vz_m_s"}, &DvlSample::velocity_D_m_s);
    c.optional([](const DvlSample& s) {
      return std::any_of(s.beam_velocity_m_s.begin(), s.beam_velocity_m_s.end(), known);
    });
    c.numbers<4>({"b1_m_s", "b2_m_s", "b3_m_s", "b4_m_s"}, &DvlSample::beam_velocity_m_s);
    c.cell("valid", read_valid, nullptr);
    c.optional([](const DvlSample& s) { return known(s.sigma_m_s); });
    c.number("sigma_m_s", &DvlSample::sigma_m_s);
    c.optional([](const DvlSample& s) { return known(s.altitude_m); });
    c.number("altitude_m", &DvlSample::altitude_m);
    c.optional([](const DvlSample& s) { return s.mode == DvlMode::water; });
    c.word<DvlMode>("mode", &DvlSample::mode, {{"bottom", DvlMode::bottom}, {"water", DvlMode::water}});
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

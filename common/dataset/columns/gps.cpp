#include "samples/gps.hpp"

#include "dataset/columns.hpp"
#include "dataset/fix_code.hpp"

namespace fathom::dataset {
namespace {

void read_fix(const CsvReader& csv, CsvReader::Column column, GpsSample& s) {
  const auto quality = fix_from_code(csv.number(column));
  if (!quality) {
    csv.fail("column fix: '" + std::string(csv.text(column)) +
             "' is not a fix quality, expected a whole number from 0");
  }
  // Without a position there is no fix, whatever the column says; a blank column vouches for the position.
  s.fix = known(s.latitude_rad) && known(s.longitude_rad) ? *quality : GpsFix::none;
}

}  // namespace

template <>
const Columns<GpsSample>& columns() {
  static const auto kColumns = [] {
    Columns<GpsSample> c;
    c.place(&GpsSample::latitude_rad, &GpsSample::longitude_rad);
    c.number("alt_m", &GpsSample::altitude_m);
    c.numbers<3>({"sigma_n_m", "sigma_e_m", "sigma_d_m"}, &GpsSample::position_sigma_N_m);
    c.numbers<3>({"vn_m_s", "ve_m_s", "vd_m_s"}, &GpsSample::velocity_N_m_s);
    c.cell("fix", read_fix, [](CsvWriter& csv, const GpsSample& s) { csv.number(code_from_fix(s.fix)); });
    c.optional([](const GpsSample& s) { return known(s.velocity_sigma_N_m_s[0]); });
    c.numbers<3>({"sigma_vn_m_s", "sigma_ve_m_s", "sigma_vd_m_s"}, &GpsSample::velocity_sigma_N_m_s);
    c.optional([](const GpsSample& s) { return s.satellites >= 0; });
    c.cell(
        "satellites",
        [](const CsvReader& csv, CsvReader::Column column, GpsSample& s) {
          const double count = csv.number(column);
          if (count >= 0.0 && count < 1000.0) s.satellites = static_cast<std::int32_t>(count);
        },
        [](CsvWriter& csv, const GpsSample& s) { csv.number(s.satellites >= 0 ? s.satellites : kUnknown); });
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

#include "samples/airspeed.hpp"

#include "dataset/columns.hpp"

namespace fathom::dataset {

template <>
const Columns<AirspeedSample>& columns() {
  static const auto kColumns = [] {
    Columns<AirspeedSample> c;
    c.number("airspeed_m_s", &AirspeedSample::airspeed_m_s);
    c.optional([](const AirspeedSample& s) { return known(s.baro_altitude_m); });
    c.number("baro_alt_m", &AirspeedSample::baro_altitude_m);
    c.optional([](const AirspeedSample& s) { return known(s.true_airspeed_m_s); });
    c.number("true_airspeed_m_s", &AirspeedSample::true_airspeed_m_s);
    return c;
  }();
  return kColumns;
}

}  // namespace fathom::dataset

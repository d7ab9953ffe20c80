#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

void describe(Schema<sim::SimulatedBeacon>& s) {
  using C = sim::SimulatedBeacon;
  s.field("address", &C::address, "number of its modem");
  s.field("place_N_m", &C::place_N_m, "north and east of the start, down from the surface")
      .unit("m")
      .range(-1e5, 1e5);
}

template <>
void describe(Schema<sim::SimulatedSensor<RangeSample>>& s) {
  using C = sim::RangeConfig;
  common_fields(s);
  s.field("beacons", &C::beacons, "they answer one after the other");
  s.field("place_sigma_m", &C::place_sigma_m, "how far each lies from its place, north and east, drawn")
      .unit("m")
      .range(0, 100);
  s.field("sigma_m", &C::sigma_m, "white error").unit("m").range(0, 100);
  s.field("sound_speed_m_s", &C::sound_speed_m_s, "of the water").unit("m/s").range(1350, 1650);
  s.field("outlier_m", &C::outlier_m, "by which an echo is longer").unit("m").range(0, 1e4);
  s.field("maximum_range_m", &C::maximum_range_m, "a beacon further off is not heard")
      .unit("m")
      .range(1, 1e5);
  s.field("minimum_depth_m", &C::minimum_depth_m, "the modem is not heard above it")
      .unit("m")
      .range(-10, 1e3);
  s.check([](const C& range) -> std::pair<std::string, std::string> {
    if (range.beacons.empty()) return {"beacons", "at least one beacon"};
    return {};
  });
}

}  // namespace fathom::config

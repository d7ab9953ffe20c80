#include "codec/registry.hpp"
#include "codec/text/numbers.hpp"
#include "config/scenario/sensors/common_fields.hpp"

namespace fathom::config {

template <>
void describe(Schema<sim::SimulatedSensor<UsblSample>>& s) {
  using C = sim::UsblConfig;
  common_fields(s);
  s.field("transponder", &C::transponder, "its name; for evologics the address of its modem, 1 to 254");
  s.field("range_fraction", &C::range_fraction, "error of each axis as a share of the slant range")
      .range(0, 1);
  s.field("floor_m", &C::floor_m, "least error").unit("m").range(0, 1e3);
  s.field("maximum_latency_s", &C::maximum_latency_s, "latency is uniform between latency_s and this")
      .unit("s")
      .range(0, 60);
  s.field("outlier_m", &C::outlier_m, "size of a multipath error").unit("m").range(0, 1e5);
  s.field("minimum_depth_m", &C::minimum_depth_m, "the transponder is not heard above it")
      .unit("m")
      .range(-10, 1e3);
  s.field("ship_N_m", &C::ship_N_m, "transceiver: north and east of the start, down from the surface")
      .unit("m")
      .range(-1e5, 1e5);
  s.field("ship_velocity_N_m_s", &C::ship_velocity_N_m_s, "of the ship: north, east, down")
      .unit("m/s")
      .range(-50, 50);
  s.field("ship_rpy_deg", &C::ship_rpy_rad, "attitude of the ship")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(-360, 360);
  s.field("ship_sigma_m", &C::ship_sigma_m, "error of the ship's place as it is sent, each axis")
      .unit("m")
      .range(0, 1e3);
  s.field("output", &C::output,
          "place of the transponder; components along north or along the ship; range and direction along the "
          "ship; or of a beacon in the ship's place along the vehicle, which carries the transceiver")
      .words({{"geodetic", C::Output::geodetic},
              {"ned", C::Output::ned},
              {"vessel", C::Output::vessel},
              {"range_bearing", C::Output::range_bearing},
              {"inverted", C::Output::inverted}});
  s.field("angle_sigma_deg", &C::angle_sigma_rad, "error of a direction, across it")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 90);
  s.field("misalignment_sigma_deg", &C::misalignment_sigma_rad,
          "error of the transceiver's axes, each axis, drawn once a run")
      .unit("deg")
      .scaled(kRadPerDeg)
      .range(0, 20);
  s.check([](const C& usbl) -> std::pair<std::string, std::string> {
    const bool polar = usbl.output == C::Output::range_bearing || usbl.output == C::Output::inverted;
    if (usbl.transponder.empty() || usbl.transponder.size() > Name::kCapacity)
      return {"transponder", "1 to 31 characters"};
    const codec::Protocol* known = codec::find_protocol(usbl.protocol);
    const std::string_view protocol = known == nullptr ? std::string_view() : known->name;
    if (protocol == "evologics") {
      const auto address = codec::parse_digits(usbl.transponder);
      if (!address || *address < 1 || *address > 254)
        return {"transponder", "the address of a modem, 1 to 254, for evologics"};
      if (usbl.output != C::Output::ned && usbl.output != C::Output::inverted)
        return {"output", "ned or inverted for evologics"};
      return {};
    }
    if (polar && !usbl.protocol.empty()) return {"output", "geodetic, ned or vessel for " + usbl.protocol};
    if (protocol == "psonlld" && usbl.output != C::Output::geodetic)
      return {"output", "geodetic for psonlld, which tells places alone"};
    return {};
  });
}

}  // namespace fathom::config

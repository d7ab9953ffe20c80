#include <array>
#include <set>
#include <string_view>

#include "config/bridge/byte_source_config.hpp"
#include "config/scenario/sensor_schema.hpp"

namespace fathom::config {
namespace {

using Violation = std::pair<std::string, std::string>;

/// Whether lines with all their columns filled give the airspeed that is wanted.
bool gives_wanted(const AirDataSensorConfig& config) {
  constexpr std::array kAny{50.0, 50.0, 1500.0, 91'500.0, 90'000.0, 1000.0, 280.0, 281.0};
  codec::AirReport report;
  for (const AirColumnConfig& column : config.line.columns) {
    const auto index = static_cast<std::size_t>(column.quantity);
    if (index < kAny.size()) (void)report.set(column.quantity, kAny[index]);
  }
  return codec::suffices(report, config.wanted);
}

}  // namespace

void describe(Schema<AirColumnConfig>& s) {
  using Q = codec::AirQuantity;
  using U = codec::AirUnit;
  s.field("quantity", &AirColumnConfig::quantity, "what the column holds; ignored: nothing of use")
      .words({{"indicated_airspeed", Q::indicated_airspeed},
              {"true_airspeed", Q::true_airspeed},
              {"impact_pressure", Q::impact_pressure},
              {"total_pressure", Q::total_pressure},
              {"static_pressure", Q::static_pressure},
              {"pressure_altitude", Q::pressure_altitude},
              {"static_temperature", Q::static_temperature},
              {"total_temperature", Q::total_temperature},
              {"ignored", Q::ignored}})
      .required();
  s.field("unit", &AirColumnConfig::unit, "of the column; none for an ignored one")
      .words({{"m/s", U::m_s},
              {"km/h", U::km_h},
              {"kn", U::kn},
              {"mph", U::mph},
              {"Pa", U::Pa},
              {"hPa", U::hPa},
              {"kPa", U::kPa},
              {"bar", U::bar},
              {"psi", U::psi},
              {"inHg", U::inHg},
              {"mmHg", U::mmHg},
              {"m", U::m},
              {"ft", U::ft},
              {"degC", U::degC},
              {"degF", U::degF},
              {"K", U::K},
              {"none", U::none}});
  s.check([](const AirColumnConfig& c) -> Violation {
    if (codec::fits(c.quantity, c.unit)) return {};
    return {"unit",
            c.quantity == Q::ignored ? "none, because the column is ignored" : "a unit of its quantity"};
  });
}

void describe(Schema<AirLineConfig>& s) {
  s.field("prefix", &AirLineConfig::prefix, "text before the first column");
  s.field("separator", &AirLineConfig::separator,
          "one character between columns; a blank stands for any number of blanks");
  s.field("columns", &AirLineConfig::columns, "quantity and unit of each, in their order");
  s.check([](const AirLineConfig& c) -> Violation {
    if (c.prefix.size() > Name::kCapacity) return {"prefix", "at most 31 characters"};
    if (c.separator.size() != 1 ||
        std::string_view("+-.0123456789*$").find(c.separator) != std::string_view::npos)
      return {"separator", "one character that is in no number and no checksum"};
    if (c.columns.empty() || c.columns.size() > codec::AirDataOptions::kMaxColumns)
      return {"columns", "1 to 16 columns"};
    std::set<codec::AirQuantity> seen;
    for (const AirColumnConfig& column : c.columns) {
      if (column.quantity != codec::AirQuantity::ignored && !seen.insert(column.quantity).second)
        return {"columns", "each quantity once"};
    }
    return {};
  });
}

void describe(Schema<AirTransducers>& s) {
  using C = AirTransducers;
  s.field("indicated_airspeed", &C::indicated_airspeed, "name in XDR; empty: not taken");
  s.field("true_airspeed", &C::true_airspeed, "name in XDR; empty: not taken");
  s.field("impact_pressure", &C::impact_pressure, "name in XDR of total less static pressure");
  s.field("total_pressure", &C::total_pressure, "name in XDR");
  s.field("static_pressure", &C::static_pressure, "name in XDR");
  s.field("pressure_altitude", &C::pressure_altitude, "name in XDR");
  s.field("static_temperature", &C::static_temperature, "name in XDR of the temperature of the air");
  s.field("total_temperature", &C::total_temperature, "name in XDR of that of air stopped by a probe");
  s.check([](const C& c) -> Violation {
    std::set<std::string> names;
    for (const std::string& name : c.list()) {
      if (name.size() > Name::kCapacity) return {"", "names of at most 31 characters"};
      if (!name.empty() && !names.insert(name).second)
        return {"", "different names, but \"" + name + "\" comes twice"};
    }
    return {};
  });
}

void describe(Schema<AirDataSensorConfig>& s) {
  using C = AirDataSensorConfig;
  s.include(&C::sensor);
  s.field("require_checksum", &C::require_checksum, "lines and sentences without a checksum are refused")
      .only_for({"ascii_air_data", "nmea_air_data"});
  s.field("airspeed", &C::wanted,
          "true: sent, or computed from speed, static pressure and temperature, and refused where these are "
          "missing; indicated: will do, and fusion takes the density of the standard atmosphere")
      .words(
          {{"true", codec::AirspeedWanted::true_airspeed}, {"indicated", codec::AirspeedWanted::indicated}});
  s.field("line", &C::line, "the line's shape").only_for({"ascii_air_data"});
  s.field("transducers", &C::transducers, "names in XDR").only_for({"nmea_air_data"});
  s.field("max_airspeed_m_s", &C::max_airspeed_m_s, "samples beyond are refused").unit("m/s").range(1, 350);
  s.check([](const C& c) -> Violation {
    const codec::Protocol* protocol = codec::find_protocol(c.sensor.protocol);
    if (protocol == nullptr || protocol->name != "ascii_air_data" || gives_wanted(c)) return {};
    return {"line.columns",
            c.wanted == codec::AirspeedWanted::indicated
                ? "a speed, an impact pressure, or total and static pressure"
                : "a true airspeed, or another speed or pressure with static pressure or pressure "
                  "altitude and with a temperature; or airspeed indicated"};
  });
}

}  // namespace fathom::config

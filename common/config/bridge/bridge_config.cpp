#include "config/bridge/bridge_config.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "config/bridge/bridge_schema.hpp"
#include "config/bridge/byte_source_config.hpp"

namespace fathom::config {
namespace {

using Violation = std::pair<std::string, std::string>;

bool is_rotation(const std::array<double, 9>& m) {
  constexpr double kTolerance = 1e-6;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double dot = 0.0;
      for (std::size_t k = 0; k < 3; ++k) dot += m[3 * i + k] * m[3 * j + k];
      if (std::abs(dot - (i == j ? 1.0 : 0.0)) > kTolerance) return false;
    }
  }
  const double determinant = m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
                             m[2] * (m[3] * m[7] - m[4] * m[6]);
  return determinant > 0.0;
}

bool is_one_of(double number, std::initializer_list<double> numbers) {
  return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

std::vector<std::string> protocol_names() {
  std::vector<std::string> names;
  for (const auto& protocol : codec::protocols()) names.emplace_back(protocol.name);
  return names;
}

// The protocol's own name for any spelling or alias; empty for no protocol.
std::string protocol_named(const std::string& text) {
  const codec::Protocol* protocol = codec::find_protocol(text);
  return protocol == nullptr ? "" : std::string(protocol->name);
}

template <class Sensor>
void require_checksum(Schema<Sensor>& s) {
  s.field("require_checksum", &Sensor::require_checksum, "NMEA 0183 sentences without a checksum are refused")
      .only_for({"nmea0183", "nmea_attitude", "psimssb", "psonlld"});
}

}  // namespace

void describe(Schema<SensorConfig>& s) {
  s.field("name", &SensorConfig::name, "name of the instrument, the second key of its topic")
      .name()
      .required();
  s.field("source", &SensorConfig::source, "where its bytes come from").required();
  s.field("protocol", &SensorConfig::protocol, "what its bytes mean: " + list_words(protocol_names()))
      .decides(protocol_names(), protocol_named)
      .required();
  s.field("time", &SensorConfig::time, "when its samples were valid").required();
  s.field("rate_hz", &SensorConfig::rate_hz, "samples per second to expect")
      .unit("Hz")
      .range(0.001, 10'000)
      .required();
  s.field("stale_after_s", &SensorConfig::stale_after_s,
          "without a sample for this long the bridge is degraded; 0: five periods, at least 2 s")
      .unit("s")
      .range(0, 86'400);
  s.field(
       "first_sample_s", &SensorConfig::first_sample_s,
       "its first sample may take this long, e.g. where water switches the instrument on; 0: stale_after_s")
      .unit("s")
      .range(0, 86'400);
  s.field("mavlink_system", &SensorConfig::mavlink_system,
          "system id of the autopilot that counts; 0: of the first that is heard")
      .range(0, 255)
      .only_for({"mavlink"});
  s.check([](const SensorConfig& c) -> Violation {
    if (codec::find_protocol(c.protocol) == nullptr)
      return {"protocol", "one of " + list_words(protocol_names())};
    return {};
  });
}

void describe(Schema<MountingConfig>& s) {
  s.field("frame", &MountingConfig::frame,
          "how the instrument names its axes: forward-right-down, forward-left-up, or by matrix")
      .words({{"frd", MountingFrame::frd}, {"flu", MountingFrame::flu}, {"matrix", MountingFrame::matrix}})
      .required();
  s.field("rpy_deg", &MountingConfig::rpy_rad,
          "roll, pitch, yaw (about z, y, x in turn) of these axes in the body")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg);
  s.field("R_BS", &MountingConfig::R_BS,
          "frame matrix: rotation of instrument axes into body FRD, row by row");
  s.check([](const MountingConfig& c) -> Violation {
    if (c.frame != MountingFrame::matrix) {
      if (c.R_BS) return {"R_BS", "nothing, because the frame is not matrix"};
      return {};
    }
    if (!c.R_BS || !is_rotation(*c.R_BS)) return {"R_BS", "9 numbers of a right-handed rotation matrix"};
    for (const double angle : c.rpy_rad) {
      if (angle != 0.0) return {"rpy_deg", "zeros, because the frame is matrix"};
    }
    return {};
  });
}

void describe(Schema<AsciiConfig>& s) {
  s.field("prefix", &AsciiConfig::prefix, "text before the number");
  s.field("scale", &AsciiConfig::scale, "the number times this, plus offset, is in the sensor's unit")
      .range(-1e9, 1e9);
  s.field("offset", &AsciiConfig::offset, "in the sensor's unit").range(-1e9, 1e9);
}

void describe(Schema<codec::Stim300Options>& s) {
  using C = codec::Stim300Options;
  s.field("accel_range_g", &C::accel_range_g,
          "range of its accelerometers: 5, 10, 30 or 80; what its configuration datagram says goes before")
      .unit("g")
      .range(5, 80);
  s.field(
       "increments_hz", &C::increments_hz,
       "its sample rate where it gives incremental angle and incremental velocity; 0: it gives angular rate "
       "and acceleration, or their averages")
      .unit("Hz")
      .range(0, 2000);
  s.check([](const C& c) -> Violation {
    if (!is_one_of(c.accel_range_g, {5, 10, 30, 80})) return {"accel_range_g", "5, 10, 30 or 80"};
    if (!is_one_of(c.increments_hz, {0, 125, 250, 500, 1000, 2000}))
      return {"increments_hz", "0, 125, 250, 500, 1000 or 2000"};
    return {};
  });
}

void describe(Schema<KvhConfig>& s) {
  using T = codec::KvhTemperature;
  s.field(
       "rotation", &KvhConfig::rotation,
       "what =ROTFMT was set to: rates, or the angles turned since the message before, which is as long ago "
       "as rate_hz says; the unit gives delta until it is told otherwise")
      .words({{"rate", KvhRotation::rate}, {"delta", KvhRotation::delta}});
  s.field("rotation_unit", &KvhConfig::angle, "what =ROTUNITS was set to")
      .words({{"rad", KvhAngle::radian}, {"deg", KvhAngle::degree}});
  s.field("temperature_unit", &KvhConfig::temperature, "what =TEMPUNITS was set to")
      .words(
          {{"C", T::celsius}, {"C_100", T::celsius_100}, {"F", T::fahrenheit}, {"F_100", T::fahrenheit_100}});
}

void describe(Schema<ImuSensorConfig>& s) {
  s.include(&ImuSensorConfig::sensor);
  s.field("mounting", &ImuSensorConfig::mounting, "how its axes lie in the vehicle").required();
  s.field("max_angular_rate_deg_s", &ImuSensorConfig::max_angular_rate_rad_s, "samples beyond are refused")
      .unit("deg/s")
      .range(1, 100'000)
      .scaled(kRadPerDeg);
  s.field("max_specific_force_m_s2", &ImuSensorConfig::max_specific_force_m_s2, "samples beyond are refused")
      .unit("m/s^2")
      .range(10, 1e6);
  s.field("stim300", &ImuSensorConfig::stim300, "what its datagrams do not say of themselves")
      .only_for({"stim300"});
  s.field("kvh", &ImuSensorConfig::kvh, "how the unit was set, which its messages do not say")
      .only_for({"kvh"});
  s.check([](const ImuSensorConfig& c) -> Violation {
    const codec::Protocol* protocol = codec::find_protocol(c.sensor.protocol);
    if (protocol == nullptr || !protocol->traits.turns_axes || c.mounting.frame != MountingFrame::flu)
      return {};
    return {"mounting.frame", "frd or matrix, because the codec of " + std::string(protocol->name) +
                                  " has turned the unit's own axes to forward-right-down already"};
  });
}

void describe(Schema<DvlSensorConfig>& s) {
  s.include(&DvlSensorConfig::sensor);
  s.field("heading_alignment_deg", &DvlSensorConfig::heading_alignment_rad,
          "rotation of recorded instrument axes about down onto the vehicle")
      .unit("deg")
      .range(-360, 360)
      .scaled(kRadPerDeg)
      .only_for({"pd0", "pd6"});
  s.field("max_speed_m_s", &DvlSensorConfig::max_speed_m_s, "samples beyond are refused")
      .unit("m/s")
      .range(0.1, 1000);
}

void describe(Schema<GpsSensorConfig>& s) {
  s.include(&GpsSensorConfig::sensor);
  require_checksum(s);
  s.field("max_speed_m_s", &GpsSensorConfig::max_speed_m_s, "samples beyond are refused")
      .unit("m/s")
      .range(0.1, 1e5);
}

void describe(Schema<DepthSensorConfig>& s) {
  s.include(&DepthSensorConfig::sensor);
  s.field("unit", &DepthSensorConfig::unit,
          "unit of the sensor's number where its protocol does not say it; m: it is a depth already")
      .words({{"m", DepthUnit::m},
              {"psi", DepthUnit::psi},
              {"dbar", DepthUnit::dbar},
              {"bar", DepthUnit::bar},
              {"mbar", DepthUnit::mbar},
              {"kPa", DepthUnit::kPa},
              {"Pa", DepthUnit::Pa}})
      .required_for({"paroscientific", "ascii_depth"});
  s.field("latitude_deg", &DepthSensorConfig::latitude_rad, "of the area of operation, for gravity")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .required();
  s.field("atmosphere_Pa", &DepthSensorConfig::atmosphere_Pa,
          "air pressure at the surface, taken off the measured one")
      .unit("Pa")
      .range(0, 120'000);
  s.field("ascii", &DepthSensorConfig::ascii, "the line's shape").only_for({"ascii_depth"});
  s.field("max_depth_m", &DepthSensorConfig::max_depth_m, "samples beyond are refused")
      .unit("m")
      .range(1, 12'000);
}

void describe(Schema<HeadingSensorConfig>& s) {
  s.include(&HeadingSensorConfig::sensor);
  require_checksum(s);
  s.field("north", &HeadingSensorConfig::north,
          "which north the heading is from where the sentence does not say it; null: magnetic of PTNTHPR, "
          "OHPR and $C, true of PRDID")
      .words({{"true", North::true_north}, {"magnetic", North::magnetic}})
      .only_for({"nmea_attitude"});
}

void describe(Schema<UsblSensorConfig>& s) {
  s.include(&UsblSensorConfig::sensor);
  require_checksum(s);
  s.field("transponder", &UsblSensorConfig::transponder, "only fixes of this transponder; empty: of all");
  s.field("carried_by", &UsblSensorConfig::carried_by,
          "who carries the transceiver: station, whose fixes are places of the vehicle, or vehicle, whose "
          "fixes are places of beacons")
      .words({{"station", codec::UsblCarrier::station}, {"vehicle", codec::UsblCarrier::vehicle}})
      .only_for({"evologics"});
  s.field(
       "beacons", &UsblSensorConfig::beacons,
       "for a transceiver on the vehicle: the beacons whose place is known, by the address of their modem; "
       "fixes of others are published without a place")
      .only_for({"evologics"});
  s.field("sigma_floor_m", &UsblSensorConfig::sigma_floor_m, "no fix is believed to be better")
      .unit("m")
      .range(0, 1000);
  s.field("max_range_m", &UsblSensorConfig::max_range_m, "relative fixes beyond are refused")
      .unit("m")
      .range(1, 1e5);
  s.check([](const UsblSensorConfig& config) { return wrong_beacons(config.beacons); });
}

void describe(Schema<ActuatorSensorConfig>& s) {
  s.include(&ActuatorSensorConfig::sensor);
  require_checksum(s);
  s.field("max_rpm", &ActuatorSensorConfig::max_rpm, "samples beyond are refused")
      .unit("1/min")
      .range(1, 1e6);
  s.field("max_fin_deg", &ActuatorSensorConfig::max_fin_rad, "samples beyond are refused")
      .unit("deg")
      .range(1, 180)
      .scaled(kRadPerDeg);
}

template LoadedConfig<ImuBridgeConfig> load_service_config(const LoadRequest& request);
template LoadedConfig<DvlBridgeConfig> load_service_config(const LoadRequest& request);
template LoadedConfig<GpsBridgeConfig> load_service_config(const LoadRequest& request);
template LoadedConfig<DepthBridgeConfig> load_service_config(const LoadRequest& request);
template LoadedConfig<HeadingBridgeConfig> load_service_config(const LoadRequest& request);
template LoadedConfig<UsblBridgeConfig> load_service_config(const LoadRequest& request);
template LoadedConfig<ActuatorBridgeConfig> load_service_config(const LoadRequest& request);
template LoadedConfig<AirDataBridgeConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<ImuBridgeConfig>();
template std::string explain_service_config<DvlBridgeConfig>();
template std::string explain_service_config<GpsBridgeConfig>();
template std::string explain_service_config<DepthBridgeConfig>();
template std::string explain_service_config<HeadingBridgeConfig>();
template std::string explain_service_config<UsblBridgeConfig>();
template std::string explain_service_config<ActuatorBridgeConfig>();
template std::string explain_service_config<AirDataBridgeConfig>();

ConfigKind imu_bridge_kind() {
  return make_kind<ImuBridgeConfig>("imu_bridge");
}
ConfigKind dvl_bridge_kind() {
  return make_kind<DvlBridgeConfig>("dvl_bridge");
}
ConfigKind gps_bridge_kind() {
  return make_kind<GpsBridgeConfig>("gps_bridge");
}
ConfigKind depth_bridge_kind() {
  return make_kind<DepthBridgeConfig>("depth_bridge");
}
ConfigKind heading_bridge_kind() {
  return make_kind<HeadingBridgeConfig>("heading_bridge");
}
ConfigKind usbl_bridge_kind() {
  return make_kind<UsblBridgeConfig>("usbl_bridge");
}
ConfigKind actuator_bridge_kind() {
  return make_kind<ActuatorBridgeConfig>("actuator_bridge");
}
ConfigKind air_data_bridge_kind() {
  return make_kind<AirDataBridgeConfig>("air_data_bridge");
}

}  // namespace fathom::config

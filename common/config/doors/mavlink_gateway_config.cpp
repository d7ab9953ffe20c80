#include "config/doors/mavlink_gateway_config.hpp"

#include <utility>

#include "base/units.hpp"
#include "config/service_schema.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;
using runtime::ByteLinkConfig;
using runtime::LinkType;

}  // namespace

void describe(Schema<ByteLinkConfig>& s) {
  using C = ByteLinkConfig;
  s.field("type", &C::type, "how the autopilot is reached")
      .words({{"udp", LinkType::udp}, {"tcp_client", LinkType::tcp_client}, {"serial", LinkType::serial}})
      .decides()
      .required();
  s.field("address", &C::address, "numeric address of the autopilot or its router")
      .only_for({"udp", "tcp_client"});
  s.field("port", &C::port, "its UDP or TCP port").range(1, 65'535).only_for({"udp", "tcp_client"});
  s.field("bind_port", &C::bind_port, "UDP port of this host; 0: any, to which it answers")
      .range(0, 65'535)
      .only_for({"udp"});
  s.field("path", &C::path, "the device, e.g. /dev/ttyAMA0").only_for({"serial"});
  s.field("baud", &C::baud, "bits per second; 8 data bits, no parity, 1 stop bit")
      .range(1200, 4'000'000)
      .only_for({"serial"});
  s.check([](const C& c) -> Fault {
    if (c.type == LinkType::serial && c.path.empty()) return {"path", "a path, because the type is serial"};
    if (c.type != LinkType::serial && !runtime::is_numeric_address(c.address))
      return {"address", "a numeric IPv4 or IPv6 address"};
    return {};
  });
}

void describe(Schema<MavlinkRates>& s) {
  s.field("odometry_hz", &MavlinkRates::odometry_hz, "ODOMETRY: pose and twist with covariance; 0: never")
      .unit("Hz")
      .range(0, 200);
  s.field("vision_position_hz", &MavlinkRates::vision_position_hz,
          "VISION_POSITION_ESTIMATE: the pose alone; 0: never")
      .unit("Hz")
      .range(0, 200);
  s.field("gps_input_hz", &MavlinkRates::gps_input_hz,
          "GPS_INPUT: as a receiver, for an autopilot that takes nothing else; 0: never")
      .unit("Hz")
      .range(0, 50);
}

void describe(Schema<MavlinkSigning>& s) {
  s.field("key_file", &MavlinkSigning::key_file,
          "64 hexadecimal digits; what is said is signed and what is not signed by it is not heard; empty: "
          "without");
  s.field("link", &MavlinkSigning::link, "number of this link in signatures").range(0, 255);
}

void describe(Schema<MavlinkOrigin>& s) {
  s.field("lat_deg", &MavlinkOrigin::latitude_rad, "latitude")
      .unit("deg")
      .range(-90, 90)
      .scaled(kRadPerDeg)
      .required();
  s.field("lon_deg", &MavlinkOrigin::longitude_rad, "longitude")
      .unit("deg")
      .range(-180, 360)
      .scaled(kRadPerDeg)
      .required();
  s.field("altitude_m", &MavlinkOrigin::altitude_m, "above the ellipsoid").unit("m").range(-12'000, 100'000);
}

void describe(Schema<MavlinkGatewayConfig>& s) {
  using C = MavlinkGatewayConfig;
  s.include(&C::common);
  s.field("link", &C::link, "to the autopilot").required();
  s.field("system_id", &C::system_id, "of the vehicle on MAVLink: the autopilot's own").range(1, 255);
  s.field("component_id", &C::component_id, "of this service; 197 is visual-inertial odometry").range(1, 255);
  s.field("frame", &C::frame, "of the pose: local_ned as PX4 expects it, local_frd as ArduPilot does")
      .words({{"local_ned", MavlinkFrame::local_ned}, {"local_frd", MavlinkFrame::local_frd}});
  s.field("messages", &C::messages, "how often what is said");
  s.field("origin", &C::origin, "where local coordinates begin; absent: at the first valid position");
  s.field("geoid_height_m", &C::geoid_height_m,
          "of the sea level above the ellipsoid where the vehicle is, for the altitude in GPS_INPUT")
      .unit("m")
      .range(-120, 120);
  s.field("valid_95_m", &C::valid_95_m, "a position whose 95 % radius is larger is said to have failed")
      .unit("m")
      .range(0.01, 1e6);
  s.field("valid_heading_deg", &C::valid_heading_rad,
          "nothing is said as long as the sigma of the heading is larger")
      .unit("deg")
      .range(0.01, 180)
      .scaled(kRadPerDeg);
  s.field("point_B_m", &C::point_B_m,
          "the point of the vehicle that is told, e.g. the autopilot, from the inertial unit: forward, "
          "right, down")
      .unit("m")
      .range(-1000, 1000);
  s.field("signing", &C::signing, "signatures of MAVLink 2");
  s.check([](const C& c) -> Fault {
    if (c.messages.odometry_hz <= 0.0 && c.messages.vision_position_hz <= 0.0 &&
        c.messages.gps_input_hz <= 0.0)
      return {"messages", "at least one rate above 0"};
    return {};
  });
}

template LoadedConfig<MavlinkGatewayConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<MavlinkGatewayConfig>();

ConfigKind mavlink_gateway_kind() {
  return make_kind<MavlinkGatewayConfig>("mavlink_gateway");
}

}  // namespace fathom::config

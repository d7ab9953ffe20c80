#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/name.hpp"
#include "base/unknown.hpp"
#include "config/bridge/instrument_port.hpp"
#include "config/common_config.hpp"
#include "config/registry.hpp"
#include "samples/kinds.hpp"

namespace fathom::config {

/// An object whose keys another description knows: they are checked where they are put to use.
struct RawObject {
  std::string json = "{}";
};

/// How an inertial unit names its axes. How they lie in the vehicle stands in `mounting_rpy_deg`.
enum class AxisNames : std::uint8_t { frd = 0, flu = 1 };

/// One instrument of the vehicle. What its model says needs not stand here.
struct VehicleInstrument {
  Name name;
  SourceKind kind = SourceKind::imu;
  std::string model;  ///< stem of a file of the catalogue; empty: of none
  bool enabled = true;
  bool watched = true;  ///< the monitor misses it
  std::optional<InstrumentPort> port;
  std::string protocol;
  double rate_hz = 0.0;
  double latency_s = 0.0;  ///< validity to arrival, of the quickest frame
  AxisNames axes = AxisNames::frd;
  std::array<double, 3> position_m{0.0, 0.0, 0.0};  ///< FRD, from any one point of the vehicle
  std::array<double, 3> mounting_rpy_rad{0.0, 0.0, 0.0};
  RawObject bridge, fusion;  ///< further keys, as in the files of these services
  /// It is a topic of ROS 2: keys of an input of the gateway, which then is its bridge.
  std::optional<RawObject> ros2;

  /// The service that brings its samples.
  [[nodiscard]] std::string_view role() const { return ros2 ? "ros2_gateway" : role_of(kind); }
};

/// What the vehicle is watched for.
struct VehicleLimits {
  double horizontal_95_m = 100.0;
  double heading_deg = 3.0;
  double gps_outage_s = 5.0;
  double alignment_s = 180.0;
};

/// One of the fusion services of the vehicle.
struct FusionRole {
  Name name{"fusion"};
  int strength = 10;
};

struct VehicleRoles {
  std::vector<FusionRole> fusion{FusionRole{}};  ///< more than one: they stand by for each other
  std::vector<std::string> expected;             ///< services that the monitor expects besides
};

/// deploy/config/vehicle.json
struct VehicleConfig {
  std::string name = "auv";
  BusConfig network;
  double latitude_rad = kUnknown;  ///< of the area of operation
  std::vector<VehicleInstrument> instruments;
  VehicleLimits limits;
  VehicleRoles roles;
  LogConfig log;
  RealtimeConfig realtime;
  std::map<std::string, RawObject> services;  ///< further keys, as in each service's file
};

[[nodiscard]] ConfigKind vehicle_kind();

/// The file of a vehicle as it stands. Throws ConfigError.
[[nodiscard]] VehicleConfig load_vehicle(const std::string& file);

/// The request with what the vehicle's file and the catalogue say of `service` beneath it. `service` is the
/// name of a kind of configuration, e.g. "fusion". Throws ConfigError.
[[nodiscard]] LoadRequest with_vehicle(LoadRequest request, const std::string& vehicle_file,
                                       std::string_view service);

/// The services that have a configuration in this vehicle: those of its instruments, and those without.
[[nodiscard]] std::vector<std::string> services_of(const VehicleConfig& vehicle);

}  // namespace fathom::config

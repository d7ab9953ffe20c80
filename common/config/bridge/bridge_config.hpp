#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/name.hpp"
#include "codec/registry.hpp"
#include "config/bridge/beacon_config.hpp"
#include "config/common_config.hpp"
#include "config/registry.hpp"
#include "runtime/byte_source.hpp"
#include "runtime/device_time.hpp"

namespace fathom::config {

/// What every instrument behind a bridge has.
struct SensorConfig {
  Name name;  ///< the second key of its topic, e.g. "gps0"
  runtime::ByteSourceConfig source;
  std::string protocol;  ///< a name or alias of codec/registry.hpp
  runtime::TimeConfig time;
  double rate_hz = 0.0;  ///< expected; below half of it the bridge is degraded
  double stale_after_s =
      0.0;  ///< without a sample for this long it is degraded; 0: five periods, at least 2 s
  double first_sample_s = 0.0;  ///< the first one may take this long, e.g. where water switches it on
  int mavlink_system = 0;       ///< of the autopilot; 0: of the first that is heard
};

/// How an instrument's axes lie in the vehicle.
enum class MountingFrame : std::uint8_t {
  frd = 0,     ///< its axes are named forward, right, down
  flu = 1,     ///< forward, left, up
  matrix = 2,  ///< R_BS says it
};

struct MountingConfig {
  MountingFrame frame = MountingFrame::frd;
  std::array<double, 3> rpy_rad{0.0, 0.0, 0.0};  ///< roll, pitch, yaw (ZYX) of those axes in the body
  std::optional<std::array<double, 9>> R_BS;     ///< row-major; turns instrument axes S into body FRD

  /// The rotation of all of the above, row-major.
  [[nodiscard]] std::array<double, 9> rotation() const;
};

enum class KvhRotation : std::uint8_t {
  rate = 0,
  delta = 1,  ///< angles turned since the message before, which come at SensorConfig::rate_hz
};
enum class KvhAngle : std::uint8_t { radian = 0, degree = 1 };

/// How a KVH unit was set, which its messages do not say.
struct KvhConfig {
  KvhRotation rotation = KvhRotation::rate;
  KvhAngle angle = KvhAngle::radian;
  codec::KvhTemperature temperature = codec::KvhTemperature::celsius;
};

struct ImuSensorConfig {
  SensorConfig sensor;
  MountingConfig mounting;
  double max_angular_rate_rad_s = 35.0;
  double max_specific_force_m_s2 = 400.0;
  codec::Stim300Options stim300;
  KvhConfig kvh;
};

struct DvlSensorConfig {
  SensorConfig sensor;
  double heading_alignment_rad = 0.0;  ///< of recorded instrument axes about down onto the vehicle
  double max_speed_m_s = 20.0;
};

struct GpsSensorConfig {
  SensorConfig sensor;
  bool require_checksum = true;
  double max_speed_m_s = 300.0;
};

/// What one unit of a depth sensor's number means.
enum class DepthUnit : std::uint8_t { m = 0, psi = 1, dbar = 2, bar = 3, mbar = 4, kPa = 5, Pa = 6 };

/// Depth as a line of text: prefix, number; the number times scale plus offset is in the configured unit.
struct AsciiConfig {
  std::string prefix;
  double scale = 1.0;
  double offset = 0.0;
};

struct DepthSensorConfig {
  SensorConfig sensor;
  DepthUnit unit = DepthUnit::psi;
  double latitude_rad = 0.0;
  double atmosphere_Pa = 101'325.0;
  AsciiConfig ascii;
  double max_depth_m = 11'000.0;
};

/// A column of an ASCII air-data line.
struct AirColumnConfig {
  codec::AirQuantity quantity = codec::AirQuantity::ignored;
  codec::AirUnit unit = codec::AirUnit::none;
};

/// Air data as a line of text: prefix, columns, separator.
struct AirLineConfig {
  std::string prefix;
  std::string separator = ",";
  std::vector<AirColumnConfig> columns{
      {codec::AirQuantity::indicated_airspeed, codec::AirUnit::kn},
      {codec::AirQuantity::pressure_altitude, codec::AirUnit::ft},
      {codec::AirQuantity::static_temperature, codec::AirUnit::degC},
  };
};

/// The names by which NMEA XDR calls what an air-data instrument measures.
struct AirTransducers {
  std::string indicated_airspeed = "IAS";
  std::string true_airspeed = "TAS";
  std::string impact_pressure = "QC";
  std::string total_pressure = "PT";
  std::string static_pressure = "PS";
  std::string pressure_altitude = "ALT";
  std::string static_temperature = "OAT";
  std::string total_temperature = "TAT";

  /// By codec::AirQuantity.
  [[nodiscard]] std::array<std::string, codec::kAirQuantities> list() const {
    return {indicated_airspeed, true_airspeed,     impact_pressure,    total_pressure,
            static_pressure,    pressure_altitude, static_temperature, total_temperature};
  }
};

struct HeadingSensorConfig {
  SensorConfig sensor;
  bool require_checksum = true;
  std::optional<North> north;  ///< of sentences that do not say it; none: that of their makers
};

struct UsblSensorConfig {
  SensorConfig sensor;
  bool require_checksum = true;
  std::string transponder;  ///< fixes of others are ignored; empty: all are taken
  codec::UsblCarrier carried_by = codec::UsblCarrier::station;
  std::vector<BeaconConfig> beacons;
  double sigma_floor_m = 0.0;
  double max_range_m = 20'000.0;
};

struct ActuatorSensorConfig {
  SensorConfig sensor;
  bool require_checksum = true;
  double max_rpm = 10'000.0;
  double max_fin_rad = 1.6;
};

struct AirDataSensorConfig {
  SensorConfig sensor;
  bool require_checksum = true;
  codec::AirspeedWanted wanted = codec::AirspeedWanted::true_airspeed;
  AirLineConfig line;
  AirTransducers transducers;
  double max_airspeed_m_s = 150.0;
};

/// The file of a bridge: the common sections and its instruments.
template <class Sensor>
struct BridgeConfig {
  CommonConfig common;
  std::vector<Sensor> sensors;
};
using ImuBridgeConfig = BridgeConfig<ImuSensorConfig>;
using DvlBridgeConfig = BridgeConfig<DvlSensorConfig>;
using GpsBridgeConfig = BridgeConfig<GpsSensorConfig>;
using DepthBridgeConfig = BridgeConfig<DepthSensorConfig>;
using HeadingBridgeConfig = BridgeConfig<HeadingSensorConfig>;
using UsblBridgeConfig = BridgeConfig<UsblSensorConfig>;
using ActuatorBridgeConfig = BridgeConfig<ActuatorSensorConfig>;
using AirDataBridgeConfig = BridgeConfig<AirDataSensorConfig>;

[[nodiscard]] ConfigKind imu_bridge_kind();
[[nodiscard]] ConfigKind dvl_bridge_kind();
[[nodiscard]] ConfigKind gps_bridge_kind();
[[nodiscard]] ConfigKind depth_bridge_kind();
[[nodiscard]] ConfigKind heading_bridge_kind();
[[nodiscard]] ConfigKind usbl_bridge_kind();
[[nodiscard]] ConfigKind actuator_bridge_kind();
[[nodiscard]] ConfigKind air_data_bridge_kind();

/// What no working instrument of its kind can mean. Values beyond are refused.
struct SampleLimits {
  double angular_rate_rad_s = 35.0;
  double specific_force_m_s2 = 400.0;
  double dvl_speed_m_s = 20.0;
  double gps_speed_m_s = 300.0;
  double depth_m = 11'000.0;
  double acoustic_range_m = 20'000.0;
  double rpm = 10'000.0;
  double fin_rad = 1.6;
  double airspeed_m_s = 150.0;
};

/// One instrument of any kind, as the bridge runtime needs it.
struct SensorPlan {
  SensorConfig sensor;
  codec::CodecOptions options;  ///< ascii_prefix is set from the member below when the codec is made
  std::string ascii_prefix;
  SampleLimits limits;
  std::array<double, 9> R_BS{1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::string transponder;
  bool dated = false;         ///< the instant that a frame names is all: one that cannot be is refused
  bool intermittent = false;  ///< fewer samples than expected are normal; none for stale_after_s is not
};

[[nodiscard]] SensorPlan sensor_plan(const ImuSensorConfig& config);
[[nodiscard]] SensorPlan sensor_plan(const DvlSensorConfig& config);
[[nodiscard]] SensorPlan sensor_plan(const GpsSensorConfig& config);
[[nodiscard]] SensorPlan sensor_plan(const DepthSensorConfig& config);
[[nodiscard]] SensorPlan sensor_plan(const HeadingSensorConfig& config);
[[nodiscard]] SensorPlan sensor_plan(const UsblSensorConfig& config);
[[nodiscard]] SensorPlan sensor_plan(const ActuatorSensorConfig& config);
[[nodiscard]] SensorPlan sensor_plan(const AirDataSensorConfig& config);

template <class Sensor>
[[nodiscard]] std::vector<SensorPlan> sensor_plans(const BridgeConfig<Sensor>& config) {
  std::vector<SensorPlan> out;
  for (const Sensor& sensor : config.sensors) out.push_back(sensor_plan(sensor));
  return out;
}

/// stale_after_s, or what it stands for when it is 0.
[[nodiscard]] double stale_after_s(const SensorConfig& config);

}  // namespace fathom::config

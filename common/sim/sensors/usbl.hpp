#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <Eigen/Geometry>

#include "geo/wgs84.hpp"
#include "samples/usbl.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct Scenario;
struct TruthPoint;

template <>
struct SimulatedSensor<UsblSample> : SensorCommon {
  static constexpr const char* kDescription = "acoustic positioning from a ship";
  std::string transponder = "B01";  ///< its name; the address of a modem is a number
  double range_fraction = 0.01;     ///< of the slant range, each axis
  double floor_m = 0.5;
  double maximum_latency_s = 2.0;           ///< latency is uniform between latency_s and this
  double outlier_m = 40.0;                  ///< multipath
  double minimum_depth_m = 1.0;             ///< of the transponder; shallower it is not heard
  std::array<double, 3> ship_N_m{0, 0, 5};  ///< transceiver: north, east of the start, down from the surface
  std::array<double, 3> ship_velocity_N_m_s{0, 0, 0};
  std::array<double, 3> ship_rpy_rad{0, 0, 0};
  /// What is sent: the place; components along N or along the ship; range and direction along the ship; or
  /// range and direction of a beacon in the ship's place along the vehicle, which carries the transceiver.
  enum class Output { geodetic, ned, vessel, range_bearing, inverted };
  Output output = Output::geodetic;
  double ship_sigma_m = 0.0;            ///< of the ship's place as it is sent, each axis
  double angle_sigma_rad = 0.005;       ///< of a direction, across it
  double misalignment_sigma_rad = 0.0;  ///< of the transceiver's axes, each, drawn once a run
};
using UsblConfig = SimulatedSensor<UsblSample>;

/// Acoustic fixes between the vehicle and a ship that lies still or keeps its course.
class UsblModel {
 public:
  UsblModel(const UsblConfig& config, const Scenario& scenario, std::uint64_t seed);
  /// Nothing when the transponder is not heard.
  std::optional<UsblSample> sample(const TruthPoint& point);
  /// Time from validity to arrival of the sample just taken.
  double latency_s();

 private:
  void relative(UsblSample& out, const TruthPoint& transponder, const geo::Geodetic& ship,
                const geo::Geodetic& heard, double sigma_m);

  UsblConfig config_;
  Random random_;
  geo::Geodetic start_;  ///< of the ship's transceiver
  double surface_altitude_m_ = 0.0;
  Eigen::Quaterniond turn_ = Eigen::Quaterniond::Identity();  ///< from the transceiver's true axes
};
template <>
struct ModelOf<UsblSample> {
  using type = UsblModel;
};

/// The device of acoustic positioning.
template <>
class SimulatedDevice<UsblSample> {
 public:
  static constexpr std::array<std::string_view, 3> kProtocols{"psimssb", "psonlld", "evologics"};
  [[nodiscard]] Bytes encode(const UsblSample& usbl, const DeviceCall& device);
};

}  // namespace fathom::sim

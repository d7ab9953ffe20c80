#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "samples/gps.hpp"
#include "sim/environment.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<GpsSample> : SensorCommon {
  static constexpr const char* kDescription = "satellite receiver";
  static constexpr bool kAlwaysHeard = true;
  static constexpr bool kTalksOn = true;  ///< without a fix
  double position_sigma_m = 0.5;          ///< white, north and east
  double altitude_sigma_m = 0.8;          ///< white
  double correlated_sigma_m = 1.0;        ///< Gauss-Markov, north and east
  double correlated_altitude_sigma_m = 1.5;
  double correlated_tau_s = 120.0;
  double velocity_sigma_m_s = 0.05;
  double velocity_down_sigma_m_s = 0.1;
  double outlier_m = 50.0;
  double reacquire_s = 2.5;           ///< from the antenna's return to the air to the first fix
  double antenna_clearance_m = 0.03;  ///< least height of the antenna above the water
};
using GpsConfig = SimulatedSensor<GpsSample>;

/// Position of an antenna with a correlated error; no fix under water, in scheduled outages, and until the
/// receiver has acquired again.
class GpsModel {
 public:
  GpsModel(const GpsConfig& config, const EnvironmentConfig& environment, std::uint64_t seed);
  /// Every inertial sample: whether the antenna is out of the water.
  void observe(const TruthPoint& point);
  [[nodiscard]] bool available() const { return available_; }
  GpsSample sample(const TruthPoint& point);

 private:
  GpsConfig config_;
  EnvironmentConfig environment_;
  Random random_;
  std::array<GaussMarkov, 3> drift_;
  double last_sample_s_ = 0.0;
  double clear_since_s_;
  bool available_ = true;
};
template <>
struct ModelOf<GpsSample> {
  using type = GpsModel;
};

/// The device of a satellite receiver.
template <>
class SimulatedDevice<GpsSample> {
 public:
  static constexpr std::array<std::string_view, 8> kProtocols{"nmea0183",  "ubx",   "novatel",     "sbf",
                                                              "vectornav", "xsens", "microstrain", "sbg"};
  [[nodiscard]] Bytes encode(const GpsSample& gps, const DeviceCall& device);
};

}  // namespace fathom::sim

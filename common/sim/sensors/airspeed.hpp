#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "samples/airspeed.hpp"
#include "sim/environment.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<AirspeedSample> : SensorCommon {
  static constexpr const char* kDescription = "air data";
  static constexpr bool kAlwaysHeard = true;
  double scale_sigma = 0.0;
  double sigma_m_s = 0.5;
  double baro_sigma_m = 0.5;
  double baro_bias_sigma_m = 2.0;
};
using AirspeedConfig = SimulatedSensor<AirspeedSample>;

class AirspeedModel {
 public:
  AirspeedModel(const AirspeedConfig& config, const EnvironmentConfig& environment, std::uint64_t seed);
  AirspeedSample sample(const TruthPoint& point);

 private:
  AirspeedConfig config_;
  double air_warmer_K_;
  Random random_;
  double scale_;
  double baro_bias_m_;
};
template <>
struct ModelOf<AirspeedSample> {
  using type = AirspeedModel;
};

/// The device of air data.
template <>
class SimulatedDevice<AirspeedSample> {
 public:
  static constexpr std::array<std::string_view, 2> kProtocols{"ascii_air_data", "nmea_air_data"};
  [[nodiscard]] Bytes encode(const AirspeedSample& airspeed, const DeviceCall& device);
};

}  // namespace fathom::sim

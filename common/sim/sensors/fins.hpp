#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "samples/actuator.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<FinsSample> : SensorCommon {
  static constexpr const char* kDescription = "fin angles";
  double sigma_rad = 0.002;
  double bias_sigma_rad = 0.0;
};
using FinsConfig = SimulatedSensor<FinsSample>;

class FinsModel {
 public:
  FinsModel(const FinsConfig& config, std::uint64_t seed);
  FinsSample sample(const TruthPoint& point);

 private:
  FinsConfig config_;
  Random random_;
  double rudder_bias_rad_;
  double stern_bias_rad_;
};
template <>
struct ModelOf<FinsSample> {
  using type = FinsModel;
};

/// The device of fins.
template <>
class SimulatedDevice<FinsSample> {
 public:
  static constexpr std::array<std::string_view, 1> kProtocols{"nmea0183"};
  [[nodiscard]] Bytes encode(const FinsSample& fins, const DeviceCall& device);
};

}  // namespace fathom::sim

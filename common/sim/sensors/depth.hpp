#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "samples/depth.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<DepthSample> : SensorCommon {
  static constexpr const char* kDescription = "pressure sensor";
  static constexpr bool kAlwaysHeard = true;
  bool wet_only = false;  ///< switched on by the water: silent in the air, else it reads the atmosphere there
  double bias_sigma_m = 0.0;
  double sigma_m = 0.02;
  double quantum_m = 0.0;
  double outlier_m = 5.0;
};
using DepthConfig = SimulatedSensor<DepthSample>;

class DepthModel {
 public:
  DepthModel(const DepthConfig& config, std::uint64_t seed);
  /// Nothing in the air when only the water switches it on.
  std::optional<DepthSample> sample(const TruthPoint& point);

 private:
  DepthConfig config_;
  Random random_;
  double bias_m_;
};
template <>
struct ModelOf<DepthSample> {
  using type = DepthModel;
};

/// The device of a pressure sensor.
template <>
class SimulatedDevice<DepthSample> {
 public:
  static constexpr std::array<std::string_view, 2> kProtocols{"paroscientific", "ascii_depth"};
  [[nodiscard]] Bytes encode(const DepthSample& depth, const DeviceCall& device);
};

}  // namespace fathom::sim

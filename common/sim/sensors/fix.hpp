#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "samples/position/fix.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<FixSample> : SensorCommon {
  static constexpr const char* kDescription =
      "somebody who tells positions by radio or modem, latency_s later";
  double sigma_m = 10.0;             ///< white, of north and of east
  double outlier_m = 1000.0;         ///< by which a wrong one is off
  double minimum_depth_m = -1000.0;  ///< shallower than this nobody looks
};
using FixConfig = SimulatedSensor<FixSample>;

/// Where somebody sees the vehicle, told when latency_s has passed.
class FixModel {
 public:
  FixModel(const FixConfig& config, std::uint64_t seed);
  std::optional<FixSample> sample(const TruthPoint& point);

 private:
  FixConfig config_;
  Random random_;
};
template <>
struct ModelOf<FixSample> {
  using type = FixModel;
};

/// A modem that passes them on.
template <>
class SimulatedDevice<FixSample> {
 public:
  static constexpr std::array<std::string_view, 1> kProtocols{"fix_text"};
  [[nodiscard]] Bytes encode(const FixSample& fix, const DeviceCall& device);
};

}  // namespace fathom::sim

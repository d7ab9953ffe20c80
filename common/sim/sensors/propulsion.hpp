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
struct SimulatedSensor<PropulsionSample> : SensorCommon {
  static constexpr const char* kDescription = "shaft speed";
  double sigma_rpm = 2.0;
  double scale_sigma = 0.0;
};
using PropulsionConfig = SimulatedSensor<PropulsionSample>;

class PropulsionModel {
 public:
  PropulsionModel(const PropulsionConfig& config, std::uint64_t seed);
  PropulsionSample sample(const TruthPoint& point);

 private:
  PropulsionConfig config_;
  Random random_;
  double scale_;
};
template <>
struct ModelOf<PropulsionSample> {
  using type = PropulsionModel;
};

/// The device of a propulsor.
template <>
class SimulatedDevice<PropulsionSample> {
 public:
  static constexpr std::array<std::string_view, 1> kProtocols{"nmea0183"};
  [[nodiscard]] Bytes encode(const PropulsionSample& propulsion, const DeviceCall& device);
};

}  // namespace fathom::sim

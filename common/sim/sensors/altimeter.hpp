#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "samples/altimeter.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<AltimeterSample> : SensorCommon {
  static constexpr const char* kDescription = "echo sounder that looks down";
  static constexpr bool kTalksOn = true;  ///< without the bottom
  double sigma_m = 0.05;                  ///< white
  double minimum_range_m = 0.3;
  double maximum_range_m = 100.0;
  double outlier_m = 5.0;
};
using AltimeterConfig = SimulatedSensor<AltimeterSample>;

/// The way along the body's down axis to a bottom that is level there. Out of the water, out of range and in
/// dropouts the altitude is unknown.
class AltimeterModel {
 public:
  AltimeterModel(const AltimeterConfig& config, std::uint64_t seed);
  AltimeterSample sample(const TruthPoint& point);

 private:
  AltimeterConfig config_;
  Random random_;
};
template <>
struct ModelOf<AltimeterSample> {
  using type = AltimeterModel;
};

/// The device of an altimeter.
template <>
class SimulatedDevice<AltimeterSample> {
 public:
  static constexpr std::array<std::string_view, 3> kProtocols{"nmea0183", "ping", "ascii_altitude"};
  [[nodiscard]] Bytes encode(const AltimeterSample& altimeter, const DeviceCall& device);

 private:
  std::uint32_t pings_ = 0;
};

}  // namespace fathom::sim

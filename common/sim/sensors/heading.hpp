#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "samples/heading.hpp"
#include "sim/environment.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

template <>
struct SimulatedSensor<HeadingSample> : SensorCommon {
  static constexpr const char* kDescription = "compass or gyrocompass";
  static constexpr bool kAlwaysHeard = true;
  double bias_sigma_rad = 0.0;
  double sigma_rad = 0.0;
  /// Deviation A + B sin psi + C cos psi + D sin 2 psi + E cos 2 psi.
  std::array<double, 5> deviation_rad{0, 0, 0, 0, 0};
  bool magnetic = false;
  double outlier_rad = 0.5;
};
using HeadingConfig = SimulatedSensor<HeadingSample>;

class HeadingModel {
 public:
  HeadingModel(const HeadingConfig& config, const EnvironmentConfig& environment, std::uint64_t seed);
  HeadingSample sample(const TruthPoint& point);

 private:
  HeadingConfig config_;
  double variation_rad_;
  Random random_;
  double bias_rad_;
};
template <>
struct ModelOf<HeadingSample> {
  using type = HeadingModel;
};

/// The device of a compass.
template <>
class SimulatedDevice<HeadingSample> {
 public:
  static constexpr std::array<std::string_view, 6> kProtocols{"nmea0183", "ubx", "novatel",
                                                              "sbf",      "sbg", "nmea_attitude"};
  [[nodiscard]] Bytes encode(const HeadingSample& heading, const DeviceCall& device);
};

}  // namespace fathom::sim

#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geo/wgs84.hpp"
#include "samples/range.hpp"
#include "sim/random.hpp"
#include "sim/sensors/device.hpp"

namespace fathom::sim {

struct TruthPoint;

/// A beacon that answers.
struct SimulatedBeacon {
  std::string address = "12";
  std::array<double, 3> place_N_m{0, 0, 20};  ///< north, east of the start, down from the surface
};

template <>
struct SimulatedSensor<RangeSample> : SensorCommon {
  static constexpr const char* kDescription = "acoustic modem that measures its distance to beacons";
  static constexpr bool kTalksOn = true;                    ///< without an answer
  std::vector<SimulatedBeacon> beacons{SimulatedBeacon{}};  ///< asked in turn
  double place_sigma_m = 0.0;                               ///< how far each lies from there, north and east
  double sigma_m = 0.3;                                     ///< white, of the range
  double sound_speed_m_s = 1500.0;                          ///< what turns the range into a travel time
  double outlier_m = 30.0;                                  ///< by which an echo is longer
  double maximum_range_m = 5000.0;
  double minimum_depth_m = 1.0;  ///< of the modem; shallower it is not heard
};
using RangeConfig = SimulatedSensor<RangeSample>;

/// Slant ranges to beacons that lie still, one after the other. An echo takes a longer way. Of a beacon that
/// does not answer the range is unknown.
class RangeModel {
 public:
  RangeModel(const RangeConfig& config, const Scenario& scenario, std::uint64_t seed);
  RangeSample sample(const TruthPoint& point);
  /// From validity to arrival of the sample just taken: the sound comes back, then the device sends.
  [[nodiscard]] double latency_s() const { return config_.latency_s + travel_time_s_; }

 private:
  RangeConfig config_;
  Random random_;
  std::vector<geo::Geodetic> lie_at_;  ///< the beacons
  geo::Geodetic start_;                ///< on the surface
  std::size_t next_ = 0;
  double travel_time_s_ = 0.0;
};
template <>
struct ModelOf<RangeSample> {
  using type = RangeModel;
};

/// The device of an acoustic modem.
template <>
class SimulatedDevice<RangeSample> {
 public:
  static constexpr std::array<std::string_view, 1> kProtocols{"micromodem"};
  [[nodiscard]] Bytes encode(const RangeSample& range, const DeviceCall& device);
};

}  // namespace fathom::sim

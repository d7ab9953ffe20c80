#pragma once

#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "estimation/engine/fusion_engine.hpp"
#include "sim/simulation.hpp"

namespace fathom::test {

inline constexpr TimeNs kDriveEpoch_ns = 1'700'000'000 * kNsPerSecond;

/// Something done to what the instruments say.
using SampleChange = std::function<void(sim::Measurement&)>;

/// A change of samples of one kind.
template <class Sample>
SampleChange change_of(std::function<void(Sample&)> change) {
  return [change = std::move(change)](sim::Measurement& measurement) {
    auto* sample = std::get_if<Sample>(&measurement);
    if (sample == nullptr) return;
    change(*sample);
    if constexpr (std::is_same_v<Sample, ImuSample>) sample->delta_time_s = kUnknown;  // of rates only
  };
}

/// As the configurations of these tests call the instruments.
template <class Sample>
void hand(estimation::FusionEngine& engine, Sample& sample) {
  if constexpr (std::is_same_v<Sample, GpsSample>) sample.header.sensor = "gps";
  if constexpr (std::is_same_v<Sample, DvlSample>) sample.header.sensor = "dvl";
  if constexpr (std::is_same_v<Sample, DepthSample>) sample.header.sensor = "depth";
  if constexpr (std::is_same_v<Sample, HeadingSample>) sample.header.sensor = "heading";
  if constexpr (requires { engine.add(sample); }) engine.add(sample);
}

/// Gives an engine what the instruments of a scenario say, and calls `each(interval, truth)` after every
/// interval of its inertial unit.
template <class Each>
void drive(estimation::FusionEngine& engine, const sim::Scenario& scenario, std::uint64_t seed,
           const SampleChange& change, Each&& each) {
  sim::Simulation::Options options;
  options.epoch_ns = kDriveEpoch_ns;
  options.seed = seed;
  sim::Simulation simulation(scenario, options);
  std::vector<sim::Measurement> measurements;
  const double rate_hz = scenario.sensors.of<ImuSample>().rate_hz;
  for (int i = 0; i < static_cast<int>(scenario.duration_s * rate_hz); ++i) {
    measurements.clear();
    simulation.advance(measurements);
    for (auto& measurement : measurements) {
      change(measurement);
      std::visit([&](auto& sample) { hand(engine, sample); }, measurement);
    }
    each(i, simulation.truth());
  }
}

/// An AUV in shallow water, at the surface, with nothing to do yet.
inline sim::Scenario auv_at(double latitude_rad, double longitude_rad) {
  sim::Scenario out;
  out.vehicle.kind = sim::VehicleConfig::Kind::auv;
  out.start.latitude_rad = latitude_rad;
  out.start.longitude_rad = longitude_rad;
  out.start.depth_m = 0.1;
  out.duration_s = 60.0;
  return out;
}

/// Makes an instrument of a scenario speak.
template <class Sample>
auto& enable(sim::Scenario& scenario, double rate_hz) {
  auto& out = scenario.sensors.template of<Sample>();
  out.enabled = true;
  out.rate_hz = rate_hz;
  return out;
}

}  // namespace fathom::test

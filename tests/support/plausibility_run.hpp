#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "estimation/engine/fusion_engine.hpp"
#include "samples/alignment/help.hpp"
#include "sim/random.hpp"
#include "sim/simulation.hpp"

namespace fathom::test {

/// An AUV that turns, dives and comes up as its seed says, with what its instruments say changed on the way.
struct PlausibilityRun {
  using Change = std::function<void(sim::Measurement&)>;
  static constexpr TimeNs kEpoch_ns = 1'700'000'000 * kNsPerSecond;

  std::string named;  ///< the last of what was found, without its prefix
  std::string advice;
  AlignmentPhase phase = AlignmentPhase::none;  ///< at the end

  /// A change of samples of one kind.
  template <class Sample>
  static Change of(std::function<void(Sample&)> change) {
    return [change = std::move(change)](sim::Measurement& measurement) {
      auto* sample = std::get_if<Sample>(&measurement);
      if (sample == nullptr) return;
      change(*sample);
      if constexpr (std::is_same_v<Sample, ImuSample>) sample->delta_time_s = kUnknown;  // of rates only
    };
  }

  PlausibilityRun(std::uint64_t seed, const Change& change) {
    const sim::Scenario scenario = drawn(seed);
    sim::Simulation simulation(scenario, options(seed));
    estimation::FusionEngine engine(config());
    AlignmentStatus status;
    std::vector<sim::Measurement> measurements;
    for (int i = 0; i < static_cast<int>(scenario.duration_s * kRate_hz); ++i) {
      measurements.clear();
      simulation.advance(measurements);
      for (auto& measurement : measurements) {
        change(measurement);
        std::visit([&](auto& sample) { hand(engine, sample); }, measurement);
      }
      if (i % 20 != 0) continue;
      engine.fill(status);
      phase = status.phase;
      const AlignmentCondition* found = implausible(status);
      if (found == nullptr) continue;
      named = std::string(found->name.view().substr(kImplausiblePrefix.size()));
      advice = status.advice.data();
    }
  }

  static estimation::EngineConfig config() {
    estimation::EngineConfig out;
    out.imu.nominal_rate_hz = kRate_hz;
    for (const auto& [kind, name] :
         {std::pair{SourceKind::gps, "gps"}, std::pair{SourceKind::dvl, "dvl"},
          std::pair{SourceKind::depth, "depth"}, std::pair{SourceKind::heading, "heading"}})
      out.sensors.push_back(estimation::default_sensor(kind, name));
    return out;
  }

 private:
  static constexpr double kRate_hz = 100.0;
  static constexpr double kDegree = std::numbers::pi / 180.0;

  static sim::Simulation::Options options(std::uint64_t seed) {
    sim::Simulation::Options out;
    out.epoch_ns = kEpoch_ns;
    out.seed = seed;
    return out;
  }

  template <class Sample>
  static void hand(estimation::FusionEngine& engine, Sample& sample) {
    if constexpr (std::is_same_v<Sample, GpsSample>) sample.header.sensor = "gps";
    if constexpr (std::is_same_v<Sample, DvlSample>) sample.header.sensor = "dvl";
    if constexpr (std::is_same_v<Sample, DepthSample>) sample.header.sensor = "depth";
    if constexpr (std::is_same_v<Sample, HeadingSample>) sample.header.sensor = "heading";
    if constexpr (requires { engine.add(sample); }) engine.add(sample);
  }

  static sim::Scenario drawn(std::uint64_t seed) {
    sim::Random random(seed, "mission");
    sim::Scenario out;
    out.vehicle.kind = sim::VehicleConfig::Kind::auv;
    out.start.latitude_rad = random.uniform(-1.2, 1.2);
    out.start.longitude_rad = random.uniform(-3.1, 3.1);
    out.start.depth_m = 0.1;
    out.environment.water_depth_m = 60.0;
    out.duration_s = 60.0;
    double heading = random.uniform(0.0, 2.0 * std::numbers::pi);
    int legs = 0;
    for (double t = 0.0; t < out.duration_s;) {
      sim::MissionStep one;
      one.at_s = t;
      one.speed_m_s = random.uniform(1.5, 2.5);
      one.heading_rad = std::remainder(heading, 2.0 * std::numbers::pi);
      one.depth_m = legs % 3 == 2 ? random.uniform(4.0, 9.0) : 0.0;
      out.mission.push_back(one);
      heading += (random.uniform(0.0, 1.0) < 0.5 ? 1.0 : -1.0) * random.uniform(30.0, 100.0) * kDegree;
      t += random.uniform(9.0, 14.0);
      ++legs;
    }
    instruments(out);
    return out;
  }

  static void instruments(sim::Scenario& out) {
    auto& imu = out.sensors.of<ImuSample>();
    imu.enabled = true;
    imu.rate_hz = kRate_hz;
    imu.gyro.bias_sigma = 5.0 * kDegree / 3600.0;
    imu.gyro.random_walk = 0.05 * kDegree / 60.0;
    imu.accelerometer.bias_sigma = 0.02;
    imu.accelerometer.random_walk = 0.1 / 60.0;
    auto& gps = out.sensors.of<GpsSample>();
    gps.enabled = true;
    gps.rate_hz = 4.0;
    gps.antenna_clearance_m = -1.0;  // it sits where the inertial unit is
    auto& dvl = out.sensors.of<DvlSample>();
    dvl.enabled = true;
    dvl.rate_hz = 5.0;
    auto& depth = out.sensors.of<DepthSample>();
    depth.enabled = true;
    depth.rate_hz = 5.0;
    auto& heading = out.sensors.of<HeadingSample>();
    heading.enabled = true;
    heading.rate_hz = 5.0;
    heading.sigma_rad = 0.5 * kDegree;
  }
};

}  // namespace fathom::test

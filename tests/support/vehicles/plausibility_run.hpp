#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>

#include "base/units.hpp"
#include "estimation/engine/fusion_engine.hpp"
#include "samples/alignment/help.hpp"
#include "sim/random.hpp"
#include "sim/simulation.hpp"
#include "support/vehicles/simulated_drive.hpp"

namespace fathom::test {

/// An AUV that turns, dives and comes up as its seed says, with what its instruments say changed on the way.
struct PlausibilityRun {
  std::string named;  ///< the last of what was found, without its prefix
  std::string advice;
  AlignmentPhase phase = AlignmentPhase::none;  ///< at the end

  PlausibilityRun(std::uint64_t seed, const SampleChange& change) {
    estimation::FusionEngine engine(config());
    AlignmentStatus status;
    drive(engine, drawn(seed), seed, change, [&](int i, const auto& /*truth*/) {
      if (i % 20 != 0) return;
      engine.fill(status);
      phase = status.phase;
      const AlignmentCondition* found = implausible(status);
      if (found == nullptr) return;
      named = std::string(found->name.view().substr(kImplausiblePrefix.size()));
      advice = status.advice.data();
    });
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

  static sim::Scenario drawn(std::uint64_t seed) {
    sim::Random random(seed, "mission");
    const double latitude_rad = random.uniform(-1.2, 1.2);
    const double longitude_rad = random.uniform(-3.1, 3.1);
    sim::Scenario out = auv_at(latitude_rad, longitude_rad);
    out.environment.water_depth_m = 60.0;
    double heading = random.uniform(0.0, 2.0 * std::numbers::pi);
    int legs = 0;
    for (double t = 0.0; t < out.duration_s;) {
      sim::MissionStep one;
      one.at_s = t;
      one.speed_m_s = random.uniform(1.5, 2.5);
      one.heading_rad = std::remainder(heading, 2.0 * std::numbers::pi);
      one.depth_m = legs % 3 == 2 ? random.uniform(4.0, 9.0) : 0.0;
      out.mission.push_back(one);
      heading += (random.uniform(0.0, 1.0) < 0.5 ? 1.0 : -1.0) * random.uniform(30.0, 100.0) * kRadPerDeg;
      t += random.uniform(9.0, 14.0);
      ++legs;
    }
    instruments(out);
    return out;
  }

  static void instruments(sim::Scenario& out) {
    auto& imu = enable<ImuSample>(out, kRate_hz);
    imu.gyro.bias_sigma = 5.0 * kRadPerDeg / 3600.0;
    imu.gyro.random_walk = 0.05 * kRadPerDeg / 60.0;
    imu.accelerometer.bias_sigma = 0.02;
    imu.accelerometer.random_walk = 0.1 / 60.0;
    enable<GpsSample>(out, 4.0).antenna_clearance_m = -1.0;  // it sits where the inertial unit is
    enable<DvlSample>(out, 5.0);
    enable<DepthSample>(out, 5.0);
    enable<HeadingSample>(out, 5.0).sigma_rad = 0.5 * kRadPerDeg;
  }
};

}  // namespace fathom::test

#pragma once

#include <vector>

#include "estimation/engine/fusion_engine.hpp"
#include "sim/simulation.hpp"

/// A vehicle dropped from an aircraft: simulated, with the engine's configuration for it.
namespace fathom::test {

using estimation::EngineConfig;
using estimation::FusionEngine;
using estimation::InitialState;
using estimation::SensorConfig;

inline constexpr TimeNs kEpoch = 1'700'000'000 * kNsPerSecond;

sim::Scenario drop();
EngineConfig drop_config();
InitialState release();

struct Fall {
  explicit Fall(double until_s, std::uint64_t seed = 1);
  std::vector<sim::Measurement> samples;
  std::vector<Truth> truth;
};

void feed(FusionEngine& engine, const sim::Measurement& measurement);

}  // namespace fathom::test

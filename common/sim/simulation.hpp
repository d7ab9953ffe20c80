#pragma once

#include <cstdint>
#include <memory>
#include <variant>
#include <vector>

#include "base/name.hpp"
#include "base/time.hpp"
#include "samples/kinds.hpp"
#include "samples/truth.hpp"
#include "sim/scenario.hpp"

namespace fathom::sim {

/// One measurement of a simulated sensor. The header says when it was valid and when its last byte arrives;
/// header.sensor is the kind's word, header.sequence counts from 0 per sensor.
using Measurement = AnySample;

/// A scenario running: truth and measurements, one inertial interval at a time. The same scenario and seed
/// give the same numbers.
class Simulation {
 public:
  struct Options {
    TimeNs epoch_ns = 0;  ///< UTC of the start
    std::uint64_t seed = 1;
    Name vehicle = "auv";
  };

  Simulation(const Scenario& scenario, const Options& options);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Moves on by one interval of the IMU and appends the measurements that became valid in it, by time of
  /// validity.
  void advance(std::vector<Measurement>& out);
  /// Seconds since the start.
  [[nodiscard]] double time_s() const;
  /// The motion now; sequence counts the intervals.
  [[nodiscard]] Truth truth() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::sim

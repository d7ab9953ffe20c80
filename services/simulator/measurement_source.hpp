#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "samples/truth.hpp"
#include "sim/scenario.hpp"
#include "sim/simulation.hpp"

namespace fathom::simulator {

/// What happens to the vehicle, in the order of time: simulated or recorded.
class MeasurementSource {
 public:
  virtual ~MeasurementSource() = default;
  /// Appends everything that becomes valid up to `until_ns` since the last call. `measurements` are in no
  /// particular order of arrival. False when nothing is left.
  virtual bool advance(TimeNs until_ns, std::vector<sim::Measurement>& measurements,
                       std::vector<Truth>& truths) = 0;
};

/// Runs the scenario for ever. The truth is given `truth_rate_hz` times a second.
[[nodiscard]] std::unique_ptr<MeasurementSource> simulate(const sim::Scenario& scenario,
                                                          const sim::Simulation::Options& options,
                                                          double truth_rate_hz);

/// Plays a recorded vehicle, t_s = 0 at `epoch_ns`. What the recording does not say about the devices is
/// taken from the scenario: latencies where nothing tells the arrival, the DVL's frame and beam angle. Throws
/// dataset::DatasetError.
[[nodiscard]] std::unique_ptr<MeasurementSource> play(const std::string& directory,
                                                      const sim::Scenario& devices,
                                                      const sim::Simulation::Options& options);

}  // namespace fathom::simulator

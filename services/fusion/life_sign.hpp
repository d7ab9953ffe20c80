#pragma once

#include <cstdint>
#include <string>

#include "base/clock.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom::fusion {

struct VerdictFigures {
  VerdictTally tally;  ///< measurements by what was said of them last
  std::uint64_t final_ones = 0;
  std::uint64_t revised = 0;  ///< verdicts that differ from the one before
  std::uint64_t dropped = 0;  ///< verdicts that were never published, because too many waited
};

/// What a fusion service says of itself each second.
class LifeSign {
 public:
  struct Counts {
    VerdictFigures verdicts;
    std::uint64_t imu_samples = 0;
    std::uint64_t nav_states = 0;  ///< published
    std::uint64_t other_vehicle = 0;
    std::uint64_t commands = 0;
    std::uint64_t orders_refused = 0;
    std::uint64_t orders_held = 0;  ///< positions that wait, or waited, for a confirmation
    std::uint64_t imu_changes = 0;  ///< of the process that writes the inertial samples
    std::uint64_t imu_rivals = 0;   ///< samples of another one that writes in its name, left out
  };
  struct Moment {
    Counts counts;
    TimeNs newest_nav_state_ns = 0;  ///< monotonic; 0: the engine has had none
    AlignmentPhase phase = AlignmentPhase::none;
    Name imu_sensor;  ///< the one listened to
    std::string how;  ///< the service came to its state
  };

  /// State, text, rates and counters. Not thread-safe.
  void fill(const Moment& now, const Clock& clock, ServiceStatus& status);

 private:
  Counts last_;
  TimeNs last_ns_ = 0;
};

}  // namespace fathom::fusion

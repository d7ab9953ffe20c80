#pragma once

#include <cstdint>
#include <string>

#include "base/clock.hpp"
#include "fusion/intake/intake.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom::fusion {

struct VerdictFigures {
  VerdictTally tally;  ///< measurements, by their last verdict
  std::uint64_t final_ones = 0;
  std::uint64_t revised = 0;  ///< verdicts that differ from an earlier one on the same measurement
  std::uint64_t dropped = 0;  ///< verdicts that were never published, because too many waited
};

/// The life sign of a fusion service, each second.
class LifeSign {
 public:
  struct Counts {
    VerdictFigures verdicts;
    Intake::Counts intake;
    std::uint64_t nav_states = 0;  ///< published
    std::uint64_t commands = 0;
    std::uint64_t orders_refused = 0;
    std::uint64_t orders_held = 0;  ///< positions that waited for a confirmation
  };
  struct Moment {
    Counts counts;
    TimeNs newest_nav_state_ns = 0;  ///< monotonic; 0: the engine has had none
    AlignmentPhase phase = AlignmentPhase::none;
    Name imu_sensor;  ///< the inertial unit in use
    std::string how;  ///< how the service came to its state, in words
  };

  /// State, text, rates and counters. Not thread-safe.
  void fill(const Moment& now, const Clock& clock, ServiceStatus& status);

 private:
  Counts last_;
  TimeNs last_ns_ = 0;
};

}  // namespace fathom::fusion

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/clock.hpp"
#include "fusion/checkpoint/keeper.hpp"
#include "fusion/intake/intake.hpp"
#include "fusion/order_answers.hpp"
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

/// That navigation waits for the instant of a given start, in words; empty when it does not.
[[nodiscard]] std::string wait_for(TimeNs begins_ns, TimeNs now_ns);

/// The life sign of a fusion service, each second.
class LifeSign {
 public:
  struct Counts {
    VerdictFigures verdicts;
    Intake::Counts intake;
    std::uint64_t nav_states = 0;  ///< published
    std::uint64_t commands = 0;
  };
  struct Moment {
    Counts counts;
    TimeNs newest_nav_state_ns = 0;  ///< monotonic; 0: the engine has had none
    AlignmentPhase phase = AlignmentPhase::none;
    Name imu_sensor;             ///< the inertial unit in use
    std::string how;             ///< how the service came to its state, in words
    TimeNs begins_ns = 0;        ///< the instant of a given start, UTC; 0: none
    TimeNs newest_stamp_ns = 0;  ///< of the newest navigation state, UTC
    OrderAnswers::Figures orders{};
    std::optional<CheckpointKeeper::Counts> checkpoints{};  ///< none: they are not asked for
  };

  /// State, text, rates and counters. Not thread-safe.
  void fill(const Moment& now, const Clock& clock, ServiceStatus& status);

 private:
  Counts last_;
  TimeNs last_ns_ = 0;
};

}  // namespace fathom::fusion

#include "fusion/life_sign.hpp"

#include <algorithm>
#include <cstdio>

namespace fathom::fusion {

void LifeSign::fill(const Moment& now, const Clock& clock, ServiceStatus& status) {
  const TimeNs clock_ns = clock.monotonic_ns();
  // A second of the vehicle's time; in an accelerated run a second of the host's, whose scheduling is no
  // faster than otherwise.
  const DurationNs patience = from_seconds(std::max(1.0, clock.rate()));
  const Counts& counts = now.counts;
  const std::string from = now.imu_sensor.empty() ? "" : " from " + now.imu_sensor.str();
  status.text.clear();
  if (now.newest_nav_state_ns == 0) {
    status.state = ServiceState::starting;
    status.text = counts.intake.imu_samples == 0 ? "waiting for inertial samples" + from
                                                 : "no inertial sample" + from + " could be used yet";
  } else if (clock_ns - now.newest_nav_state_ns > patience) {
    status.state = ServiceState::degraded;
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "no usable inertial sample%s for %.1f s", from.c_str(),
                  to_seconds(clock_ns - now.newest_nav_state_ns));
    status.text = text.data();
  } else if (now.phase == AlignmentPhase::timed_out || now.phase == AlignmentPhase::lost) {
    status.state = ServiceState::degraded;
    status.text = "alignment " + std::string(now.phase == AlignmentPhase::lost ? "lost" : "timed out");
  } else {
    status.state = ServiceState::healthy;
    status.text = now.how;
  }
  const double span_s = to_seconds(clock_ns - last_ns_);
  if (last_ns_ != 0 && span_s > 0.0) {
    status.rates.push_back(
        {"imu", static_cast<double>(counts.intake.imu_samples - last_.intake.imu_samples) / span_s});
    status.rates.push_back({"nav_state", static_cast<double>(counts.nav_states - last_.nav_states) / span_s});
  }
  status.counters.push_back({"imu_samples", counts.intake.imu_samples});
  status.counters.push_back({"nav_states", counts.nav_states});
  for (std::size_t kind = 0; kind < kVerdictKinds; ++kind) {
    status.counters.push_back(
        {to_string(static_cast<VerdictKind>(kind)), counts.verdicts.tally.counts()[kind]});
  }
  status.counters.push_back({"final_verdicts", counts.verdicts.final_ones});
  status.counters.push_back({"revised_verdicts", counts.verdicts.revised});
  status.counters.push_back({"dropped_verdicts", counts.verdicts.dropped});
  if (const std::uint64_t dropped = counts.verdicts.dropped - last_.verdicts.dropped; dropped > 0) {
    if (status.state == ServiceState::healthy) status.state = ServiceState::degraded;
    status.text += (status.text.empty() ? "" : "; ") + std::to_string(dropped) +
                   " verdicts were dropped because too many waited to be published";
  }
  status.counters.push_back({"other_vehicle", counts.intake.other_vehicle});
  status.counters.push_back({"commands", counts.commands});
  status.counters.push_back({"orders_refused", counts.orders_refused});
  status.counters.push_back({"orders_held", counts.orders_held});
  status.counters.push_back({"imu_writer_changes", counts.intake.imu_changes});
  status.counters.push_back({"imu_rival_samples", counts.intake.imu_rivals});
  if (counts.intake.imu_rivals > last_.intake.imu_rivals) {
    if (status.state == ServiceState::healthy) status.state = ServiceState::degraded;
    status.text += (status.text.empty() ? "" : "; ") + std::string("another process writes samples") + from +
                   " as well, which are left out";
  }
  last_ = counts;
  last_ns_ = clock_ns;
}

}  // namespace fathom::fusion

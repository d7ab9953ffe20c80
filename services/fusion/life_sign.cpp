#include "fusion/life_sign.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "base/iso8601.hpp"

namespace fathom::fusion {
namespace {

void append(std::string& text, const std::string& more) {
  text += (text.empty() ? "" : "; ") + more;
}

/// Without checkpoints the next start knows nothing of where the vehicle is.
void fill(const CheckpointKeeper::Counts& kept, ServiceStatus& status) {
  status.counters.push_back({"checkpoints", kept.written});
  status.counters.push_back({"checkpoints_failed", kept.failed});
  if (kept.failure.empty()) return;
  if (status.state == ServiceState::healthy) {
    status.state = ServiceState::degraded;
    status.text.clear();
  }
  append(status.text, "a restart would begin anew: checkpoint " + kept.failure);
}

}  // namespace

std::string wait_for(TimeNs begins_ns, TimeNs now_ns) {
  if (begins_ns <= now_ns) return {};
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "waits for the instant of the given start, %s, in %.0f s",
                to_iso8601(begins_ns).c_str(), to_seconds(begins_ns - now_ns));
  return text.data();
}

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
  } else if (std::string wait = wait_for(now.begins_ns, now.newest_stamp_ns); !wait.empty()) {
    status.state = ServiceState::starting;
    status.text = std::move(wait);
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
    append(status.text,
           std::to_string(dropped) + " verdicts were dropped because too many waited to be published");
  }
  status.counters.push_back({"other_vehicle", counts.intake.other_vehicle});
  status.counters.push_back({"commands", counts.commands});
  status.counters.push_back({"orders_refused", now.orders.refused});
  status.counters.push_back({"orders_held", now.orders.held});
  status.counters.push_back({"orders_not_done", now.orders.not_done});
  status.counters.push_back({"imu_writer_changes", counts.intake.imu_changes});
  status.counters.push_back({"imu_rival_samples", counts.intake.imu_rivals});
  if (counts.intake.imu_rivals > last_.intake.imu_rivals) {
    if (status.state == ServiceState::healthy) status.state = ServiceState::degraded;
    append(status.text, "another process writes samples" + from + " as well, which are left out");
  }
  if (now.checkpoints) fathom::fusion::fill(*now.checkpoints, status);
  if (!now.orders.note.empty()) {
    // The text has an end: what makes fusion unwell goes before it, how it started behind.
    if (status.state == ServiceState::healthy)
      status.text.insert(0, now.orders.note + (status.text.empty() ? "" : "; "));
    if (status.state != ServiceState::healthy) append(status.text, now.orders.note);
  }
  last_ = counts;
  last_ns_ = clock_ns;
}

}  // namespace fathom::fusion

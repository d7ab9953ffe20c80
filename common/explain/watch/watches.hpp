#pragma once

#include "explain/finding.hpp"
#include "explain/history.hpp"
#include "explain/watch/track.hpp"

/// Each looks for one sort of cause or effect in a history and appends what it finds. Thresholds stand in
/// the files, each with its reason.
namespace fathom::explain {

/// clock_set, clock_jump.
void watch_clocks(const History& history, Findings& out);
/// second_writer, takeover, restart, stalled.
void watch_writers(const History& history, Findings& out);
/// imu_late, imu_gap. `out` holds the findings of clocks.
void watch_inertial(const History& history, Findings& out);
/// not_aligned.
void watch_alignment(const History& history, Findings& out);
/// interference.
void watch_receivers(const History& history, Findings& out);
/// frozen, jump, drag, outliers, wrong_heading of a compass, refused.
void watch_refusals(const History& history, const Track& track, Findings& out);
/// noisy. `out` holds the findings of refusals: noise is not told as outliers as well.
void watch_noise(const History& history, Findings& out);
/// biased.
void watch_biases(const History& history, Findings& out);
/// wrong_heading, by what GPS and a DVL tell of the course over ground.
void watch_course(const History& history, const Track& track, Findings& out);
/// wrong_lever. `out` holds the findings of all before.
void watch_lever(const History& history, const Track& track, Findings& out);
/// lost.
void watch_losses(const History& history, const Track& track, Findings& out);
/// state_gap, reset, growth.
void watch_states(const History& history, const Track& track, Findings& out);

}  // namespace fathom::explain

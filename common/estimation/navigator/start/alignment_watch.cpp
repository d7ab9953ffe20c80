#include "estimation/navigator/start/alignment_watch.hpp"

#include <algorithm>

namespace fathom::estimation {

void AlignmentWatch::enter(AlignmentPhase next, TimeNs now_ns) {
  if (next == phase) return;
  phase = next;
  phase_since_ns = now_ns;
}

void AlignmentWatch::judge(const EngineConfig& config, const Eigen::Vector3d& rpy_sigma_rad,
                           Plausible plausible, TimeNs now_ns) {
  const Eigen::Vector3d& sigma = rpy_sigma_rad;
  const double tilt_rad = config.aligned_tilt_sigma_rad();
  const double worst = std::max(
      {sigma.x() / tilt_rad, sigma.y() / tilt_rad, sigma.z() / config.alignment.aligned_heading_sigma_rad});
  // Twice as wide to fall out of as to come in, so that the phase does not flap.
  if (plausible == Plausible::no || worst > (phase == AlignmentPhase::aligned ? 2.0 : 1.0)) {
    hold_since_ns = 0;
    enter(AlignmentPhase::fine, now_ns);
    return;
  }
  if (hold_since_ns == 0) hold_since_ns = now_ns;
  if (plausible == Plausible::yes && to_seconds(now_ns - hold_since_ns) >= config.alignment.aligned_hold_s)
    enter(AlignmentPhase::aligned, now_ns);
}

}  // namespace fathom::estimation

#pragma once

#include "estimation/engine_config.hpp"
#include "geo/so3.hpp"
#include "samples/alignment_status.hpp"

namespace fathom::estimation {

/// What is known of the instruments.
enum class Plausible : std::uint8_t { not_heard_enough, yes, no };

/// The phase of the alignment, and how long it has lasted.
struct AlignmentWatch {
  AlignmentPhase phase = AlignmentPhase::none;
  TimeNs phase_since_ns = 0;
  TimeNs waiting_since_ns = 0;
  TimeNs hold_since_ns = 0;  ///< the sigmas are within their limits; 0: they are not

  void enter(AlignmentPhase next, TimeNs now_ns);
  /// Fine or aligned, by the sigmas of roll, pitch and yaw; never aligned by what is not plausible, nor
  /// before that is known.
  void judge(const EngineConfig& config, const Eigen::Vector3d& rpy_sigma_rad, Plausible plausible,
             TimeNs now_ns);
  /// It has waited for longer than the configuration gives it.
  [[nodiscard]] bool is_late(const EngineConfig& config, TimeNs now_ns) const {
    return to_seconds(now_ns - waiting_since_ns) > config.alignment.timeout_s;
  }

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.phase_since_ns);
    visit(self.waiting_since_ns);
    visit(self.hold_since_ns);
  }
};

}  // namespace fathom::estimation

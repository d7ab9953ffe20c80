#pragma once

#include <algorithm>

#include "estimation/aiding/policy.hpp"
#include "estimation/navigator/estimate.hpp"
#include "samples/nav_state.hpp"

namespace fathom::estimation {

/// When navigation was last given a position or a velocity, and what it lives on.
struct Usage {
  TimeNs gps_used_ns = 0;
  TimeNs usbl_used_ns = 0;
  TimeNs dvl_used_ns = 0;
  TimeNs bottom_used_ns = 0;     ///< of its velocities those over ground
  TimeNs bottom_refused_ns = 0;  ///< or a component of it
  TimeNs velocity_used_ns = 0;
  TimeNs gap_ns = 0;  ///< the last end of a time without inertial samples

  /// A measurement was used; `placed`: as a position, horizontally.
  void note(const AidingPolicy& brought, bool placed, TimeNs now_ns);
  /// A measurement was refused, or components of it.
  void note_refusal(const AidingPolicy& brought, TimeNs now_ns) {
    if (brought.doppler && brought.velocity == VelocityOver::ground) bottom_refused_ns = now_ns;
  }
  /// While it navigates.
  [[nodiscard]] NavMode mode(const EngineConfig& config, const Estimate& estimate) const;
  /// A velocity over ground was used lately: what is measured along the vehicle is then over ground as well.
  [[nodiscard]] bool knows_ground(const EngineConfig& config, const Estimate& estimate) const {
    return estimate.since(bottom_used_ns) <= config.velocity_timeout_s;
  }
  /// And the estimate agrees with the last one.
  [[nodiscard]] bool agrees_with_ground(const EngineConfig& config, const Estimate& estimate) const {
    return knows_ground(config, estimate) && bottom_used_ns > bottom_refused_ns;
  }

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.gps_used_ns);
    visit(self.usbl_used_ns);
    visit(self.dvl_used_ns);
    visit(self.bottom_used_ns);
    visit(self.bottom_refused_ns);
    visit(self.velocity_used_ns);
    visit(self.gap_ns);
  }
};

inline void Usage::note(const AidingPolicy& brought, bool placed, TimeNs now_ns) {
  if (placed && brought.fix == Fix::satellite) gps_used_ns = now_ns;
  if (placed && brought.fix == Fix::acoustic) usbl_used_ns = now_ns;
  if (brought.doppler) dvl_used_ns = now_ns;
  if (brought.doppler && brought.velocity == VelocityOver::ground) bottom_used_ns = now_ns;
  if (brought.velocity != VelocityOver::none) velocity_used_ns = now_ns;
}

inline NavMode Usage::mode(const EngineConfig& config, const Estimate& estimate) const {
  // Comparisons with NaN are false: never used.
  if (estimate.since(gps_used_ns) <= config.gps_timeout_s) return NavMode::gps_aided;
  if (estimate.since(usbl_used_ns) <= config.usbl_timeout_s) return NavMode::acoustic_aided;
  if (estimate.since(velocity_used_ns) <= config.velocity_timeout_s) return NavMode::dead_reckoning;
  return NavMode::inertial;
}

}  // namespace fathom::estimation

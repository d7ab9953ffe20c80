#pragma once

#include "estimation/navigator/estimate.hpp"

namespace fathom::estimation {

/// What is known about the motion without an instrument: wheels do not slip sideways, depth stays, somebody
/// says that the vehicle rests. These rows come with the inertial steps, at instants that depend on nothing
/// but the stamps, so a roll-back repeats them to the bit.
class Constraints {
 public:
  /// Somebody says that the vehicle rests for so long from now on.
  void mark_at_rest(TimeNs now_ns, double for_s) {
    rest_until_ns_ = now_ns + from_seconds(for_s);
    next_zero_velocity_ns_ = now_ns;
  }
  /// After a step. True when it gave the estimate a velocity.
  [[nodiscard]] bool apply(const Setup& setup, const ImuStep& step, Estimate& estimate);

  template <class Self, class Visit>
  static void for_each_instant(Self& self, Visit&& visit) {
    visit(self.rest_until_ns_);
    visit(self.next_zero_velocity_ns_);
  }

  /// For archives: see fields/navigator.hpp.
  template <class Archive, class Self>
  static void fields(Archive& archive, Self& self);

 private:
  TimeNs rest_until_ns_ = 0;
  TimeNs next_zero_velocity_ns_ = 0;
};

}  // namespace fathom::estimation

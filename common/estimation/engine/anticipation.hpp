#pragma once

#include <array>

#include "estimation/navigator/measurement.hpp"
#include "estimation/navigator/setup.hpp"

namespace fathom::estimation {

/// Foresees the stamps of measurements that come late, from the last two of each instrument: a snapshot just
/// before such a stamp leaves nothing to repeat but what follows it. A guess, which costs work where it is
/// wrong and changes no result.
class Anticipation {
 public:
  /// A measurement has arrived while the newest inertial sample ended at `newest_ns`.
  void heard(const Measurement& measurement, TimeNs newest_ns);
  /// Whether an instrument that comes late may be stamped in the `dt_ns` after `now_ns`, or so little later
  /// that the next step is too late for a snapshot. The answer is the instant until which such a measurement
  /// may be on its way; 0: none is expected.
  [[nodiscard]] TimeNs expected_until_ns(TimeNs now_ns, DurationNs dt_ns) const;
  void forget() { *this = {}; }

 private:
  struct Expected {
    TimeNs stamp_ns = 0;  ///< of the last one
    DurationNs period_ns = 0;
    DurationNs delay_ns = 0;  ///< from the stamp to the newest sample at its arrival
  };
  std::array<Expected, kMaxSensors> expected_{};
  std::size_t heard_ = 0;  ///< none behind the first so many has been heard
};

}  // namespace fathom::estimation

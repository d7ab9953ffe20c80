#pragma once

#include <optional>

#include "base/time.hpp"
#include "estimation/engine_config.hpp"
#include "samples/altimeter.hpp"
#include "samples/verdict.hpp"

namespace fathom::estimation {

struct Setup;
class Navigator;

/// The newest height above the bottom that was heard. It informs and does not aid: nothing that is estimated
/// depends on it. Not part of saved states: after a takeover the next sample says it again.
class Bottom {
 public:
  explicit Bottom(const AltimeterConfig& config);
  /// In any order; samples without altitude, of others and older ones are left out. Why one is refused whose
  /// stamp is none: it is no instant of this age, or further ahead of the last instant than what is fresh.
  /// Before the first instant nothing tells which stamp is right, and the last one counts.
  std::optional<VerdictKind> take(const AltimeterSample& sample);
  /// With each inertial sample, of that instant: what has been taken so far is what altitude_m() goes by.
  void latch(TimeNs now_ns);
  /// Height of the output point above the bottom below the altimeter, which is level there: the way along the
  /// axis turned into the vertical, the lever, and the way up or down since the stamp. Unknown where nothing
  /// is fresh, before navigation, and where the axis is further than 60 degrees off the vertical.
  [[nodiscard]] double altitude_m(const Setup& setup, const Navigator& navigator) const;

 private:
  struct Heard {
    TimeNs stamp_ns = 0;
    double altitude_m = 0.0;
    bool vertical = false;
  };
  AltimeterConfig config_;
  std::optional<TimeNs> now_ns_;
  std::optional<Heard> newest_;
  std::optional<Heard> latched_;
};

}  // namespace fathom::estimation

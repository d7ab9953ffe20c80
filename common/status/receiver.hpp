#pragma once

#include <cstdint>
#include <string>

#include "status/view.hpp"

namespace fathom::status {

/// Why a satellite receiver gives navigation nothing, or navigation takes nothing from it.
enum class ReceiverTrouble : std::uint8_t {
  no_fix,    ///< it is heard and has none, as under water
  refused,   ///< it has a fix that navigation refuses
  disputed,  ///< the same, for so long that it or navigation is far wrong
  frozen,    ///< it repeats one fix
  disabled,  ///< by order or configuration
  silent,    ///< nothing comes from it: its cable, port, bridge or power
};

struct ReceiverWord {
  Name name;
  ReceiverTrouble trouble = ReceiverTrouble::no_fix;
  double for_s = kUnknown;
  VerdictKind as = VerdictKind::used;  ///< how its fixes are judged, where that is known

  /// "gps has a fix that navigation has refused for 32.5 s"; empty where it has none.
  [[nodiscard]] std::string phrase() const;
  /// What to do, a sentence; empty where it has no fix, which to surface will bring.
  [[nodiscard]] std::string advice() const;
};

/// Whether this is said of a fix that the receiver stands by and navigation does not take.
[[nodiscard]] bool is_refused_fix(VerdictKind kind);
/// Why that receiver is out, by its last verdicts and the monitor's alarms. The view has a monitor.
[[nodiscard]] ReceiverWord why_out(const StatusView& view, const ReceiverOutage& receiver);
/// Why the vehicle is without GPS: the word on the receiver that is nearest to a usable fix.
[[nodiscard]] ReceiverWord why_no_gps(const StatusView& view);

}  // namespace fathom::status

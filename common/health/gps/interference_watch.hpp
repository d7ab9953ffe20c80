#pragma once

#include <map>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/gps.hpp"

namespace fathom::health {

/// What receivers themselves say of interference: "gps_jammed:<receiver>", a warning, and
/// "gps_spoofed:<receiver>", a warning where it is indicated and critical where it is affirmed. A receiver
/// that says nothing raises nothing.
class InterferenceWatch {
 public:
  /// True when the fix may be counted on: its receiver does not affirm that it is spoofed.
  bool add(const GpsSample& sample, const Instant& now);
  void report(AlarmBook& book, const Instant& now) const;

 private:
  struct Receiver {
    GpsJamming jamming = GpsJamming::unknown;
    GpsSpoofing spoofing = GpsSpoofing::unknown;
    TimeNs heard_ns = 0;         ///< monotonic
    TimeNs jammed_since_ns = 0;  ///< 0: it is not
    TimeNs spoofed_since_ns = 0;
  };
  std::map<Name, Receiver> receivers_;
};

}  // namespace fathom::health

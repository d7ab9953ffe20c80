#pragma once

#include <map>
#include <utility>

#include "health/alarm_book.hpp"
#include "health/freshness.hpp"
#include "health/instant.hpp"
#include "samples/gps.hpp"

namespace fathom::health {

/// A watch over what receivers report of interference: "gps_jammed:<receiver>", a warning, and
/// "gps_spoofed:<receiver>", a warning when spoofing is indicated and critical when it is affirmed. A
/// receiver that reports nothing, or that counts as missing, raises no alarm.
class InterferenceWatch {
 public:
  explicit InterferenceWatch(Freshness fresh = {}) : fresh_(std::move(fresh)) {}

  /// Returns whether the fix may be used: its receiver does not affirm spoofing.
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
  Freshness fresh_;
  std::map<Name, Receiver> receivers_;
};

}  // namespace fathom::health

#pragma once

#include <map>
#include <utility>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

struct RefusalWatchConfig {
  double limit_s = 10.0;  ///< fusion has to refuse a sensor throughout this time ...
  int minimum = 5;        ///< ... and at least so many of its measurements, to raise the alarm
};

/// A watch for sensors that talk but are not believed: fusion judged every measurement and used none. A
/// measurement that carries nothing to use (no fix, no bottom lock: out_of_range) is not a disagreement and
/// does not count.
class RefusalWatch {
 public:
  explicit RefusalWatch(const RefusalWatchConfig& config) : config_(config) {}

  void add(const Verdict& verdict, const Instant& now);
  /// "refused:<sensor>".
  void report(AlarmBook& book, const Instant& now) const;

 private:
  struct Source {
    int refused = 0;  ///< in a row
    TimeNs since_ns = 0;
    TimeNs last_ns = 0;
    VerdictKind kind = VerdictKind::rejected;
    Name model;  ///< that judged the last
  };

  RefusalWatchConfig config_;
  std::map<std::pair<SourceKind, Name>, Source> sources_;
};

}  // namespace fathom::health

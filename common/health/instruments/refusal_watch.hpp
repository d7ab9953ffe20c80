#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <utility>

#include "health/alarm_book.hpp"
#include "health/freshness.hpp"
#include "health/instant.hpp"
#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

struct RefusalWatchConfig {
  double limit_s = 10.0;  ///< fusion has to refuse a sensor throughout this time ...
  int minimum = 5;        ///< ... and at least so many of its measurements, to raise the alarm
};

/// A watch for sensors that talk but are not believed: fusion judged every measurement and used none. A
/// measurement that carries nothing to use (no fix, no bottom lock: out_of_range) is not a disagreement and
/// does not count. An alarm outlives the pauses between the measurements of a slow instrument: it stays until
/// the sensor counts as missing and twice the usual pause between its refusals has passed.
class RefusalWatch {
 public:
  explicit RefusalWatch(const RefusalWatchConfig& config, Freshness fresh = {})
      : config_(config), fresh_(std::move(fresh)) {}

  void add(const Verdict& verdict, const Instant& now);
  /// A state that is new is an inertial sample that was used: those get no verdict. Fusion integrates one
  /// unit alone, and what it refuses of another one is not a disagreement (source_disabled).
  void add(const NavState& state);
  /// "refused:<sensor>".
  void report(AlarmBook& book, const Instant& now) const;

 private:
  struct Source {
    int refused = 0;  ///< in a row
    TimeNs since_ns = 0;
    TimeNs last_ns = 0;
    TimeNs stamp_ns = 0;               ///< of the last refused measurement
    std::array<double, 5> pauses_s{};  ///< before the last ones of the row
    std::size_t pauses = 0;            ///< so many of the row so far
    VerdictKind kind = VerdictKind::rejected;
    Name model;  ///< that judged the last
  };

  static void refuse(Source& source, const Verdict& verdict, const Instant& now);
  /// The median of the last pauses, so that a missed measurement does not count; 0 when there was none.
  [[nodiscard]] static double period_s(const Source& source);

  RefusalWatchConfig config_;
  Freshness fresh_;
  std::map<std::pair<SourceKind, Name>, Source> sources_;
  TimeNs nav_stamp_ns_ = 0;
};

}  // namespace fathom::health

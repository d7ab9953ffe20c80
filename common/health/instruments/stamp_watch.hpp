#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "health/alarm_book.hpp"
#include "health/freshness.hpp"
#include "health/instant.hpp"
#include "samples/status/health.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

struct StampWatchConfig {
  int duplicates = 5;         ///< so many repeated stamps ...
  double window_s = 10.0;     ///< ... within this time are an alarm, until none repeats for as long
  double clock_jump_s = 1.0;  ///< a lasting change of stamp minus arrival by more than this is a jump
};

/// A watch over the stamps of sensors, by the monitor's own clock.
///
/// The age of samples (arrival minus stamp) wanders and jitters, and its range so far is kept. A clock jumped
/// when every sample of two seconds, and three at least, lies beyond that range by more than the limit, and
/// all of them lie within half the limit of each other. Late bursts after a stall scatter, and a damaged
/// stamp stands alone, so that neither is a jump. What holds of a sensor or a bridge holds until it counts as
/// missing.
class StampWatch {
 public:
  explicit StampWatch(const StampWatchConfig& config, Freshness fresh = {})
      : config_(config), fresh_(std::move(fresh)) {}

  void heard(SourceKind kind, const SampleHeader& header, const Instant& now);
  /// Takes the counters of a bridge, which sees its device's clock before it mends the stamps.
  void add(const ServiceStatus& status, const Instant& now);
  /// "duplicate_stamps:<sensor>", "clock_jump:<sensor>" (momentary), "clock_ahead:<sensor>",
  /// "device_clock:<bridge>".
  void report(AlarmBook& book, const Instant& now);

 private:
  struct Sensor {
    bool heard = false;
    TimeNs heard_ns = 0;
    TimeNs last_stamp_ns = 0;
    int repeats = 0;  ///< within the window
    TimeNs repeats_since_ns = 0;
    TimeNs repeated_ns = 0;

    bool aged = false;  ///< the range is known
    double low_s = 0.0;
    double high_s = 0.0;
    int beyond = 0;  ///< samples in a row outside the range
    TimeNs beyond_since_ns = 0;
    double beyond_low_s = 0.0;
    double beyond_high_s = 0.0;
    double jumped_s = 0.0;  ///< since the last report; 0: it did not
    double age_s = 0.0;     ///< of the last sample
    int ahead = 0;          ///< samples in a row from the future
  };
  struct Bridge {
    bool known = false;
    TimeNs heard_ns = 0;
    std::uint64_t steps = 0;
    std::uint64_t implausible = 0;
    bool stepped = false;      ///< since the last report
    bool disbelieved = false;  ///< at the last life sign
    TimeNs disbelieved_since_ns = 0;
  };

  void count_repeat(Sensor& sensor, const Instant& now) const;
  void follow_age(Sensor& sensor, double age_s, const Instant& now) const;

  void report_bridges(AlarmBook& book, const Instant& now);

  StampWatchConfig config_;
  Freshness fresh_;
  std::map<std::pair<SourceKind, Name>, Sensor> sensors_;
  std::map<Name, Bridge> bridges_;
};

}  // namespace fathom::health

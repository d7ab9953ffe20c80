#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/doors/nmea_out_config.hpp"
#include "nmea_out/report.hpp"

namespace fathom::nmea_out {

/// When an output says what. Sentences fall on whole multiples of their periods in UTC, so that those of
/// equal rates belong to the same instant and several outputs agree.
class Schedule {
 public:
  explicit Schedule(const config::NmeaOutputConfig& output);

  /// The sentences that are due with a report, one after the other in the order of the configuration; empty
  /// when none is.
  [[nodiscard]] std::string due(const Report& report);

 private:
  struct Entry {
    config::NmeaSentence sentence;
    DurationNs period_ns;
    std::int64_t said_in = INT64_MIN;  ///< the period in which it was last said
  };

  std::string talker_;
  std::vector<Entry> entries_;
};

}  // namespace fathom::nmea_out

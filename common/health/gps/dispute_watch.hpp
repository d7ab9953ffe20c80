#pragma once

#include <map>
#include <utility>

#include "health/alarm_book.hpp"
#include "health/freshness.hpp"
#include "health/instant.hpp"
#include "samples/verdict.hpp"

namespace fathom::health {

/// A watch for receivers that fusion has refused for so long that either they or navigation are far wrong:
/// "gps_disputed:<receiver>", critical. Nothing on board can tell which of them is wrong, so the alarm asks a
/// person.
class DisputeWatch {
 public:
  explicit DisputeWatch(Freshness fresh = {}) : fresh_(std::move(fresh)) {}

  void add(const Verdict& verdict, const Instant& now);
  void report(AlarmBook& book, const Instant& now) const;

 private:
  struct Receiver {
    bool disputed = false;
    TimeNs since_ns = 0;  ///< monotonic; of the first refusal in a row
    TimeNs last_ns = 0;
    int refused = 0;            ///< in a row
    double apart_m = kUnknown;  ///< horizontally, fix and estimate
    double sigma_m = kUnknown;  ///< of that
  };
  Freshness fresh_;
  std::map<Name, Receiver> receivers_;
};

}  // namespace fathom::health

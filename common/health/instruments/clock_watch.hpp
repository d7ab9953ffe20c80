#pragma once

#include <map>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

/// Hosts whose clock was set while services were running, by the offset that these publish. Their stamps are
/// not moved by it, so it is a notice: "clock_step" (momentary).
class ClockWatch {
 public:
  void add(const ServiceStatus& status, const Instant& now);
  void report(AlarmBook& book, const Instant& now);

 private:
  static constexpr std::size_t kMaxNames = 64;  ///< names come from the network: bounded
  struct Service {
    TimeNs started_ns = 0;
    DurationNs offset_ns = 0;
  };
  struct Step {
    TimeNs noticed_ns = 0;  ///< monotonic
    double step_s = 0.0;
    bool reported = false;
  };
  std::map<Name, Service> services_;
  std::map<std::string, Step> steps_;  ///< the last one of each host
};

}  // namespace fathom::health

#pragma once

#include <map>

#include "health/alarm_book.hpp"
#include "health/instant.hpp"
#include "samples/status/health.hpp"

namespace fathom::health {

/// A watch for hosts whose clock was set while services were running, by the offset that the services
/// publish. The stamps do not move with it, so the alarm is a notice: "clock_step" (momentary).
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
  std::map<std::string, Step> steps_;  ///< the last step of each host
};

}  // namespace fathom::health

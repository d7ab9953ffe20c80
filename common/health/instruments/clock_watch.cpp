#include "health/instruments/clock_watch.hpp"

#include <cmath>

#include "health/text.hpp"

namespace fathom::health {
namespace {

constexpr double kStepS = 0.5;                      // slow correction by a time server passes unnoticed
constexpr DurationNs kTogether = 3 * kNsPerSecond;  // the services of a host notice the same step within this

}  // namespace

void ClockWatch::add(const ServiceStatus& status, const Instant& now) {
  auto found = services_.find(status.header.sensor);
  if (found == services_.end()) {
    if (services_.size() >= kMaxNames) return;
    found = services_.emplace(status.header.sensor, Service{}).first;
  }
  Service& service = found->second;
  const bool another = service.started_ns != status.started_ns;
  const double step_s = another ? 0.0 : to_seconds(status.utc_offset_ns) - to_seconds(service.offset_ns);
  service = {status.started_ns, status.utc_offset_ns};
  if (std::abs(step_s) < kStepS) return;
  const auto host = steps_.find(status.host);
  if (host == steps_.end() && steps_.size() >= kMaxNames) return;
  if (host != steps_.end() && now.monotonic_ns - host->second.noticed_ns < kTogether) return;
  steps_[status.host] = {now.monotonic_ns, step_s, false};
}

void ClockWatch::report(AlarmBook& book, const Instant& now) {
  for (auto& [host, step] : steps_) {
    if (step.reported) continue;
    step.reported = true;
    book.event({.key = "clock_step",
                .severity = Severity::notice,
                .text = sentence("The clock of %.60s was set %s by %s; stamps are not moved by it.",
                                 host.c_str(), step.step_s > 0.0 ? "forward" : "back",
                                 duration_text(std::abs(step.step_s)).c_str()),
                .value = step.step_s,
                .limit = kStepS},
               now);
  }
}

}  // namespace fathom::health

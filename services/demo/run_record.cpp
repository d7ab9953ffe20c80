#include "demo/run_record.hpp"

#include <algorithm>

namespace fathom::demo {
namespace {

constexpr std::size_t kLatencies = 200'000;
constexpr DurationNs kScorePeriodNs = 100 * kNsPerMillisecond;

bool usable(const GpsSample& sample) {
  return sample.fix >= GpsFix::fix_3d && known(sample.latitude_rad) && known(sample.longitude_rad);
}

}  // namespace

double Observation::aligned_after_s() const {
  if (aligned_ns == 0) return kUnknown;
  TimeNs began = truth_began_ns != 0 ? truth_began_ns : began_ns;
  if (first_nav_ns != 0) began = std::min(began, first_nav_ns);  // a recording's reference may begin later
  return to_seconds(aligned_ns - began);
}

double Observation::latency_us(double share) const {
  if (latencies_us.empty()) return kUnknown;
  std::vector<float> values = latencies_us;
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

RunRecord::RunRecord(const Options& options, TimeNs began_ns) : options_(options) {
  seen_.began_ns = began_ns;
  seen_.latencies_us.reserve(kLatencies);
}

double RunRecord::since_began_s(TimeNs stamp_ns) const {
  return to_seconds(stamp_ns - seen_.began_ns);
}

void RunRecord::add(const NavState& state, double latency_us) {
  if (seen_.nav_states++ == 0) seen_.first_nav_ns = state.header.stamp_ns;
  seen_.last_nav_ns = state.header.stamp_ns;
  seen_.nav = state;
  const auto latency = static_cast<float>(latency_us);
  if (seen_.latencies_us.size() < kLatencies) {
    seen_.latencies_us.push_back(latency);
  } else {
    seen_.latencies_us[next_latency_++ % kLatencies] = latency;
  }
  const bool has_position = state.mode != NavMode::none && state.mode != NavMode::aligning;
  if (!has_position || since_began_s(state.header.stamp_ns) < options_.score_from_s) return;
  if (state.header.stamp_ns - last_scored_ns_ < kScorePeriodNs) return;
  last_scored_ns_ = state.header.stamp_ns;
  to_score_.push_back(state);
}

void RunRecord::add(const Truth& row) {
  if (seen_.truth_began_ns == 0) seen_.truth_began_ns = row.header.stamp_ns;
  truth_.add(row);
  // A navigation state is scored once the truth has passed it; one that the truth leaves out is dropped.
  while (!to_score_.empty() && to_score_.front().header.stamp_ns <= row.header.stamp_ns) {
    if (const auto reference = truth_.at(to_score_.front().header.stamp_ns)) {
      scorer_.add(dataset::error_of(to_score_.front(), *reference));
    }
    to_score_.pop_front();
  }
}

void RunRecord::add(const GpsSample& sample) {
  if (!usable(sample)) return;
  const TimeNs stamp = sample.header.stamp_ns;
  if (last_usable_fix_ns_ != 0 && to_seconds(stamp - last_usable_fix_ns_) > options_.gps_limit_s) {
    // The monitor may have flagged it already; then the entry exists and only its end was missing.
    if (seen_.outages.empty() || known(seen_.outages.back().end_s)) {
      seen_.outages.push_back({since_began_s(last_usable_fix_ns_), kUnknown, kUnknown, kUnknown});
    }
    seen_.outages.back().end_s = since_began_s(stamp);
  }
  last_usable_fix_ns_ = std::max(last_usable_fix_ns_, stamp);
}

void RunRecord::add(const MonitorStatus& status) {
  const double now_s = since_began_s(status.header.stamp_ns);
  if (status.gps_outage_active && !flagged_ && last_usable_fix_ns_ != 0) {
    seen_.outages.push_back({since_began_s(last_usable_fix_ns_), kUnknown, kUnknown, kUnknown});
    seen_.outages.back().flagged_after_s = now_s - seen_.outages.back().start_s;
  } else if (!status.gps_outage_active && flagged_ && !seen_.outages.empty()) {
    GpsOutage& outage = seen_.outages.back();
    if (known(outage.end_s)) outage.cleared_after_s = now_s - outage.end_s;
  }
  flagged_ = status.gps_outage_active;
  seen_.monitor = status;
}

void RunRecord::add(const ServiceStatus& status, TimeNs monotonic_ns) {
  ServiceRecord& record = seen_.services[status.header.sensor.str()];
  record.state = status.state;
  record.last_heard_ns = monotonic_ns;
  const bool healthy = status.state == ServiceState::healthy;
  if (!healthy) record.text = status.text;
  // A stumble is not a fall: as for the monitor, a service is unwell when it stays degraded.
  const bool degraded = record.was_healthy && status.state == ServiceState::degraded;
  if (!degraded) record.degraded_since_ns = 0;
  if (degraded && record.degraded_since_ns == 0) record.degraded_since_ns = record.last_heard_ns;
  record.fell = record.fell || (degraded && to_seconds(record.last_heard_ns - record.degraded_since_ns) >=
                                                options_.degraded_hold_s);
  record.was_healthy = record.was_healthy || healthy;
}

void RunRecord::add(const AlignmentStatus& status) {
  seen_.alignment = status;
  if (status.phase == AlignmentPhase::aligned && seen_.aligned_ns == 0)
    seen_.aligned_ns = status.header.stamp_ns;
}

void RunRecord::add(const Verdict& verdict) {
  ++seen_.verdicts[verdict.header.sensor.str()].at(static_cast<std::size_t>(verdict.kind));
}

void RunRecord::add(const Alarm& alarm) {
  seen_.alarms[alarm.alarm.str()] = alarm;
}

Observation RunRecord::look() const {
  Observation out = seen_;
  if (!scorer_.errors().empty()) {
    out.score = scorer_.score();
    out.error = scorer_.errors().back();
    out.distance_m = truth_.distance_m(out.score.first_ns, out.score.last_ns);
  }
  return out;
}

}  // namespace fathom::demo

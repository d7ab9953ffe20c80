#include "demo/run_record.hpp"

#include <algorithm>

#include "samples/position/gives_position.hpp"

namespace fathom::demo {
namespace {

constexpr std::size_t kLatencies = 200'000;
constexpr DurationNs kScorePeriodNs = 100 * kNsPerMillisecond;

bool usable(const GpsSample& sample) {
  return sample.fix >= GpsFix::fix_3d && known(sample.latitude_rad) && known(sample.longitude_rad);
}

template <std::size_t N>
bool all_known(const std::array<double, N>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return known(value); });
}

bool has_position(const NavState& state) {
  return gives_position(state.mode);
}

/// A state that guidance can steer by.
bool is_valid(const NavState& state) {
  return has_position(state) && state.alignment != AlignmentPhase::lost && known(state.latitude_rad) &&
         known(state.longitude_rad) && all_known(state.velocity_N_m_s) && all_known(state.q_NB);
}

}  // namespace

double Observation::aligned_after_s() const {
  return aligned_ns == 0 ? kUnknown : to_seconds(aligned_ns - vehicle_began_ns());
}

TimeNs Observation::vehicle_began_ns() const {
  const TimeNs began = truth_began_ns != 0 ? truth_began_ns : began_ns;
  return first_nav_ns != 0 ? std::min(began, first_nav_ns)
                           : began;  // a recording's reference may begin later
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
  if (state.header.stamp_ns <= seen_.last_nav_ns) return;
  if (seen_.nav_states++ == 0) seen_.first_nav_ns = state.header.stamp_ns;
  seen_.last_nav_ns = state.header.stamp_ns;
  seen_.nav = state;
  const auto latency = static_cast<float>(latency_us);
  if (seen_.latencies_us.size() < kLatencies) {
    seen_.latencies_us.push_back(latency);
  } else {
    seen_.latencies_us[next_latency_++ % kLatencies] = latency;
  }
  if (since_began_s(state.header.stamp_ns) < options_.score_from_s) return;
  const bool valid = is_valid(state);
  if (valid && seen_.valid_states++ == 0) seen_.first_valid_ns = state.header.stamp_ns;
  if (seen_.valid_states > 0) ++seen_.states_since_valid;
  if (!has_position(state)) return;
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
  auto& outages = seen_.outages;
  const bool after_silence = silent_longer_than_limit(stamp);
  // The monitor may have flagged it already; then the entry exists and only its end was missing. A fix or two
  // between two silences do not end an outage that the monitor still shows.
  if (after_silence && (outages.empty() || (!flagged_ && known(outages.back().end_s)))) {
    outages.push_back({.start_s = since_began_s(last_usable_fix_ns_)});
  }
  const bool awaited = flagged_ && !outages.empty() && !known(outages.back().end_s);
  if (after_silence || awaited) outages.back().end_s = since_began_s(stamp);
  last_usable_fix_ns_ = std::max(last_usable_fix_ns_, stamp);
}

bool RunRecord::silent_longer_than_limit(TimeNs until_ns) const {
  return last_usable_fix_ns_ != 0 && to_seconds(until_ns - last_usable_fix_ns_) > options_.gps_limit_s;
}

void RunRecord::add(const MonitorStatus& status) {
  const double now_s = since_began_s(status.header.stamp_ns);
  if (status.gps_outage_active && !flagged_ && last_usable_fix_ns_ != 0) {
    seen_.outages.push_back({.start_s = since_began_s(last_usable_fix_ns_)});
    seen_.outages.back().flagged_after_s = now_s - seen_.outages.back().start_s;
  } else if (!status.gps_outage_active && flagged_ && !seen_.outages.empty()) {
    GpsOutage& outage = seen_.outages.back();
    if (known(outage.end_s)) outage.cleared_after_s = now_s - outage.end_s;
    outage.cleared_without_fix = !known(outage.end_s);
  }
  flagged_ = status.gps_outage_active;
  seen_.monitor = status;
}

void RunRecord::add(const ServiceStatus& status, TimeNs monotonic_ns) {
  ServiceRecord& record = seen_.services[status.header.sensor.str()];
  if (record.last_heard_ns != 0) {
    record.longest_silence_s =
        std::max(record.longest_silence_s, to_seconds(monotonic_ns - record.last_heard_ns));
  }
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
  seen_.verdicts[verdict.header.sensor.str()].add(verdict);
}

void RunRecord::add(const Alarm& alarm) {
  seen_.alarms[alarm.alarm.str()] = alarm;
}

Observation RunRecord::look(TimeNs utc_ns, TimeNs monotonic_ns) const {
  Observation out = seen_;
  out.ended_ns = options_.ends_ns != 0 ? std::min(utc_ns, options_.ends_ns) : utc_ns;
  for (auto& [name, service] : out.services) {
    service.longest_silence_s =
        std::max(service.longest_silence_s, to_seconds(monotonic_ns - service.last_heard_ns));
  }
  if (silent_longer_than_limit(out.ended_ns)) {
    // It lasts: unflagged so far, or flagged and not ended by the fix or two in between.
    if (!flagged_ || out.outages.empty())
      out.outages.push_back({.start_s = since_began_s(last_usable_fix_ns_)});
    out.outages.back().end_s = kUnknown;
  }
  if (!scorer_.errors().empty()) {
    out.score = scorer_.score();
    out.error = scorer_.errors().back();
    out.distance_m = truth_.distance_m(out.score.first_ns, out.score.last_ns);
  }
  return out;
}

}  // namespace fathom::demo

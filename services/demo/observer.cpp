#include "demo/observer.hpp"

#include <algorithm>

#include "bus/reader.hpp"

namespace fathom::demo {
namespace {

constexpr std::size_t kLatencies = 200'000;
constexpr DurationNs kScorePeriodNs = 100 * kNsPerMillisecond;

bool usable(const GpsSample& sample) {
  return sample.fix >= GpsFix::fix_3d && known(sample.latitude_rad) && known(sample.longitude_rad);
}

float percentile(std::vector<float> values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

double Observation::aligned_after_s() const {
  if (aligned_ns == 0) return kUnknown;
  TimeNs began = truth_began_ns != 0 ? truth_began_ns : began_ns;
  if (first_nav_ns != 0) began = std::min(began, first_nav_ns);  // a recording's reference may begin later
  return to_seconds(aligned_ns - began);
}

struct Observer::Readers {
  Readers(Observer& self, bus::Participant& participant)
      : truth(participant, [&self](const Truth& row, const bus::SampleInfo&) { self.on_truth(row); }),
        nav(participant, [&self](const NavState& state, const bus::SampleInfo&) { self.on_nav(state); }),
        gps(participant, [&self](const GpsSample& sample, const bus::SampleInfo&) { self.on_gps(sample); }),
        monitor(participant,
                [&self](const MonitorStatus& status, const bus::SampleInfo&) { self.on_monitor(status); }),
        service(participant,
                [&self](const ServiceStatus& status, const bus::SampleInfo&) { self.on_service(status); }),
        alignment(participant,
                  [&self](const AlignmentStatus& status, const bus::SampleInfo&) {
                    const std::lock_guard lock(self.mutex_);
                    self.seen_.alignment = status;
                    if (status.phase == AlignmentPhase::aligned && self.seen_.aligned_ns == 0) {
                      self.seen_.aligned_ns = status.header.stamp_ns;
                    }
                  }),
        verdict(
            participant,
            [&self](const Verdict& verdict, const bus::SampleInfo&) {
              const std::lock_guard lock(self.mutex_);
              ++self.seen_.verdicts[verdict.header.sensor.str()].at(static_cast<std::size_t>(verdict.kind));
            }),
        alarm(participant, [&self](const Alarm& alarm, const bus::SampleInfo&) {
          const std::lock_guard lock(self.mutex_);
          self.seen_.alarms[alarm.alarm.str()] = alarm;
        }) {}

  bus::Reader<Truth> truth;
  bus::Reader<NavState> nav;
  bus::Reader<GpsSample> gps;
  bus::Reader<MonitorStatus> monitor;
  bus::Reader<ServiceStatus> service;
  bus::Reader<AlignmentStatus> alignment;
  bus::Reader<Verdict> verdict;
  bus::Reader<Alarm> alarm;
};

Observer::Observer(bus::Participant& participant, const Clock& clock, const Options& options)
    : clock_(clock), options_(options) {
  seen_.began_ns = clock.utc_ns();
  latencies_us_.reserve(kLatencies);
  readers_ = std::make_unique<Readers>(*this, participant);
}

Observer::~Observer() = default;

double Observer::since_began_s(TimeNs stamp_ns) const {
  return to_seconds(stamp_ns - seen_.began_ns);
}

void Observer::on_nav(const NavState& state) {
  const TimeNs now = clock_.utc_ns();
  const std::lock_guard lock(mutex_);
  if (seen_.nav_states++ == 0) seen_.first_nav_ns = state.header.stamp_ns;
  seen_.last_nav_ns = state.header.stamp_ns;
  seen_.nav = state;
  const auto latency = static_cast<float>(to_seconds(now - state.header.received_ns) * 1e6 / clock_.rate());
  if (latencies_us_.size() < kLatencies) {
    latencies_us_.push_back(latency);
  } else {
    latencies_us_[next_latency_++ % kLatencies] = latency;
  }
  const bool has_position = state.mode != NavMode::none && state.mode != NavMode::aligning;
  if (!has_position || since_began_s(state.header.stamp_ns) < options_.score_from_s) return;
  if (state.header.stamp_ns - last_scored_ns_ < kScorePeriodNs) return;
  last_scored_ns_ = state.header.stamp_ns;
  to_score_.push_back(state);
}

void Observer::on_truth(const Truth& row) {
  const std::lock_guard lock(mutex_);
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

void Observer::on_gps(const GpsSample& sample) {
  if (!usable(sample)) return;
  const std::lock_guard lock(mutex_);
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

void Observer::on_monitor(const MonitorStatus& status) {
  const std::lock_guard lock(mutex_);
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

void Observer::on_service(const ServiceStatus& status) {
  const std::lock_guard lock(mutex_);
  ServiceRecord& record = seen_.services[status.header.sensor.str()];
  record.state = status.state;
  record.last_heard_ns = clock_.monotonic_ns();
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

Observation Observer::look() const {
  std::vector<float> latencies;
  Observation out;
  {
    const std::lock_guard lock(mutex_);
    out = seen_;
    latencies = latencies_us_;
    if (!scorer_.errors().empty()) {
      out.score = scorer_.score();
      out.error = scorer_.errors().back();
      out.distance_m = truth_.distance_m(out.score.first_ns, out.score.last_ns);
    }
  }
  if (!latencies.empty()) {
    out.latency_p50_us = percentile(latencies, 0.50);
    out.latency_p99_us = percentile(std::move(latencies), 0.99);
  }
  return out;
}

}  // namespace fathom::demo

#include "status/book.hpp"

#include "status/receiver.hpp"

namespace fathom::status {
namespace {

constexpr DurationNs kRateWindow = 2 * kNsPerSecond;
constexpr std::size_t kMostNames = 64;  // names come from the network: bounded

}  // namespace

bool StatusBook::ours(const SampleHeader& header) {
  if (vehicle_.empty()) vehicle_ = header.vehicle.str();
  return header.vehicle.view() == vehicle_;
}

bool StatusBook::add(const NavState& state, TimeNs monotonic_ns) {
  if (!ours(state.header)) return false;
  if (!nav_ || nav_->sample.header.stamp_ns != state.header.stamp_ns) nav_ = {state, monotonic_ns};
  nav_times_.push_back(monotonic_ns);
  while (monotonic_ns - nav_times_.front() > kRateWindow) nav_times_.pop_front();
  return true;
}

bool StatusBook::add(const AlignmentStatus& status, TimeNs monotonic_ns) {
  if (!ours(status.header)) return false;
  alignment_ = {status, monotonic_ns};
  return true;
}

bool StatusBook::add(const MonitorStatus& status, TimeNs monotonic_ns) {
  if (!ours(status.header)) return false;
  monitor_ = {status, monotonic_ns};
  return true;
}

bool StatusBook::add(const Forecast& forecast, TimeNs monotonic_ns) {
  if (!ours(forecast.header)) return false;
  forecast_ = {forecast, monotonic_ns};
  return true;
}

bool StatusBook::add(const ServiceStatus& status, TimeNs monotonic_ns) {
  if (!ours(status.header)) return false;
  if (services_.size() < kMostNames || services_.contains(status.header.sensor)) {
    services_[status.header.sensor] = {status, monotonic_ns};
  }
  return true;
}

bool StatusBook::add(const Alarm& alarm, TimeNs) {
  if (!ours(alarm.header)) return false;
  if (!alarm.active && alarm.acknowledged) {
    alarms_.erase(alarm.alarm);
  } else if (alarms_.size() < 2 * kMostNames || alarms_.contains(alarm.alarm)) {
    alarms_[alarm.alarm] = alarm;
  }
  return true;
}

bool StatusBook::add(const Verdict& verdict, TimeNs monotonic_ns) {
  if (!ours(verdict.header)) return false;
  if (verdicts_.size() >= kMostNames && !verdicts_.contains(verdict.header.sensor)) return true;
  if (!is_news(verdict)) return true;
  Judged& judged = verdicts_[verdict.header.sensor];
  judged.last_ns = monotonic_ns;
  judged.counts.last = verdict.kind;
  if (!is_refused_fix(verdict.kind)) {
    judged.refused_since_ns = 0;
  } else if (judged.refused_since_ns == 0) {
    judged.refused_since_ns = monotonic_ns;
  }
  VerdictCounts& counts = judged.counts;
  if (verdict.revision > 0) {
    // Counted before as something else, unless its first verdict was not heard.
    std::uint64_t& before = verdict.previous == VerdictKind::used ? counts.used : counts.not_used;
    if (before == 0) return true;
    --before;
  }
  if (verdict.kind == VerdictKind::used) {
    ++counts.used;
  } else {
    ++counts.not_used;
    counts.last_refusal = verdict.kind;
  }
  return true;
}

double StatusBook::nav_rate(TimeNs now_ns) const {
  if (nav_times_.size() < 2 || now_ns - nav_times_.back() > kRateWindow) return kUnknown;
  const DurationNs span = nav_times_.back() - nav_times_.front();
  return span > 0 ? static_cast<double>(nav_times_.size() - 1) / to_seconds(span) : kUnknown;
}

DurationNs StatusBook::heard_for_ns(TimeNs monotonic_ns) const {
  if (!nav_ || !monitor_ || nav_times_.empty()) return 0;
  return monotonic_ns - nav_times_.front();
}

StatusView StatusBook::view(TimeNs monotonic_ns) const {
  StatusView view;
  view.vehicle = vehicle_;
  view.nav = aged(nav_, monotonic_ns);
  view.nav_rate_hz = nav_rate(monotonic_ns);
  view.alignment = aged(alignment_, monotonic_ns);
  view.monitor = aged(monitor_, monotonic_ns);
  view.forecast = aged(forecast_, monotonic_ns);
  for (const auto& [name, stamped] : services_) {
    view.services[name] = {stamped.sample, to_seconds(monotonic_ns - stamped.at_ns)};
  }
  view.alarms = alarms_;
  for (const auto& [name, judged] : verdicts_) {
    VerdictCounts& counts = view.verdicts[name] = judged.counts;
    counts.last_age_s = to_seconds(monotonic_ns - judged.last_ns);
    if (judged.refused_since_ns != 0)
      counts.refused_for_s = to_seconds(monotonic_ns - judged.refused_since_ns);
  }
  return view;
}

}  // namespace fathom::status

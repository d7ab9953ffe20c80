#include "console/view/vehicle_view.hpp"

#include <algorithm>
#include <utility>

#include "console/view/fix_place.hpp"

namespace fathom::console {
namespace {

constexpr std::size_t kMostNames = 64;  // names come from the network: bounded
constexpr std::size_t kMostWaiting = 64;
constexpr std::uint64_t kServicesEvery = 10;  // ticks; routes as well
// Fusion judges a fix within its horizon; what it never mentions is shown as it is.
constexpr DurationNs kFixPatienceNs = 2 * kNsPerSecond;

}  // namespace

VehicleView::VehicleView(Options options) : options_(std::move(options)), book_(options_.vehicle) {}

void VehicleView::add(const NavState& state, const health::Instant& at) {
  if (!book_.add(state, at.monotonic_ns)) return;
  nav_latency_s_ = to_seconds(at.utc_ns - state.header.received_ns);
  history_.add(state);
}

std::optional<health::Departure> VehicleView::departure_of(const Command& order) const {
  const NavState* const state = book_.navigation();
  return state == nullptr ? std::nullopt : health::departure(order, *state);
}

void VehicleView::add(const NavDetail& detail, const health::Instant&) {
  if (detail.header.vehicle.view() != options_.vehicle) return;
  history_.add(detail);
  detail_ = detail;
}

void VehicleView::add(const Verdict& verdict, const health::Instant& at) {
  if (!book_.add(verdict, at.monotonic_ns) || !is_news(verdict)) return;
  history_.add(verdict);
  judge_fix(verdict);
  beacons_.judge(verdict);
  if (sources_.size() >= kMostNames && !sources_.contains(verdict.header.sensor)) return;
  Source& source = sources_[verdict.header.sensor];
  source.line.sensor = verdict.header.sensor;
  source.line.kind = verdict.source;
  source.tally.add(verdict);
  source.line.counts = source.tally.counts();
  // A later verdict on an older measurement says nothing about the sensor as it is now.
  if (verdict.revision > 0 && verdict.header.stamp_ns != source.stamp_ns) return;
  source.stamp_ns = verdict.header.stamp_ns;
  source.line.last = verdict.kind;
  source.line.last_ratio = verdict.test_ratio;
  source.line.latency_s = to_seconds(verdict.header.received_ns - verdict.header.stamp_ns);
  if (verdict.revision == 0) source.heard_ns = at.monotonic_ns;
  if (verdict.kind == VerdictKind::used) source.used_ns = at.monotonic_ns;
}

void VehicleView::add(const AlignmentStatus& status, const health::Instant& at) {
  book_.add(status, at.monotonic_ns);
}
void VehicleView::add(const MonitorStatus& status, const health::Instant& at) {
  book_.add(status, at.monotonic_ns);
}
void VehicleView::add(const Forecast& forecast, const health::Instant& at) {
  book_.add(forecast, at.monotonic_ns);
}
void VehicleView::add(const Alarm& alarm, const health::Instant& at) {
  book_.add(alarm, at.monotonic_ns);
}

void VehicleView::add(const ServiceStatus& status, const health::Instant& at) {
  if (!book_.add(status, at.monotonic_ns)) return;
  if (services_.size() >= kMostNames && !services_.contains(status.header.sensor)) return;
  ServiceLine& line = services_[status.header.sensor];
  const bool known = line.status.started_ns != 0;
  if (known && (line.status.started_ns != status.started_ns || line.status.pid != status.pid))
    ++line.restarts;
  line.status = status;
}

void VehicleView::add(const GpsSample& sample, const health::Instant& at) {
  if (sample.header.vehicle.view() != options_.vehicle) return;
  if (auto fix = place_of(sample)) add_fix(*fix, at);
}

void VehicleView::add(const UsblSample& sample, const health::Instant& at) {
  if (sample.header.vehicle.view() != options_.vehicle) return;
  if (auto fix = place_of(sample)) add_fix(*fix, at);
}

void VehicleView::add(const FixSample& sample, const health::Instant& at) {
  if (sample.header.vehicle.view() != options_.vehicle) return;
  if (auto fix = place_of(sample)) add_fix(*fix, at);
}

void VehicleView::add(const RangeSample& sample, const health::Instant& at) {
  if (sample.header.vehicle.view() == options_.vehicle) beacons_.add(sample, at);
}

std::optional<std::string> VehicleView::add(const Route& route, const health::Instant& at) {
  if (route.header.vehicle.view() != options_.vehicle) return std::nullopt;
  return routes_.add(route, at);
}

void VehicleView::add_fix(FixRow fix, const health::Instant& at) {
  for (std::size_t i = 0; i < judged_.size(); ++i) {
    const Judged& judged = judged_[i];
    if (judged.stamp_ns == fix.utc_ns && judged.sensor == fix.sensor) fix.verdict = judged.kind;
  }
  if (fix.verdict || waiting_.size() >= kMostWaiting) {
    history_.add(fix);
  } else {
    waiting_.push_back({fix, at.monotonic_ns});
  }
}

void VehicleView::judge_fix(const Verdict& verdict) {
  const bool of_a_fix = verdict.source == SourceKind::gps || verdict.source == SourceKind::usbl ||
                        verdict.source == SourceKind::fix;
  if (!of_a_fix) return;
  const auto at = std::find_if(waiting_.begin(), waiting_.end(), [&](const WaitingFix& fix) {
    return fix.row.utc_ns == verdict.header.stamp_ns && fix.row.sensor == verdict.header.sensor;
  });
  if (at == waiting_.end()) {
    if (verdict.revision > 0) history_.revise_fix(verdict);
    judged_.push({verdict.header.sensor, verdict.header.stamp_ns, verdict.kind});
    return;
  }
  at->row.verdict = verdict.kind;
  history_.add(at->row);
  waiting_.erase(at);
}

void VehicleView::release_fixes(TimeNs monotonic_ns) {
  const auto patient = std::find_if(waiting_.begin(), waiting_.end(), [&](const WaitingFix& fix) {
    return monotonic_ns - fix.arrived_ns < kFixPatienceNs;
  });
  for (auto fix = waiting_.begin(); fix != patient; ++fix) history_.add(fix->row);
  waiting_.erase(waiting_.begin(), patient);
}

Tick VehicleView::tick(const health::Instant& at) {
  if (began_ns_ == 0) began_ns_ = at.monotonic_ns;
  release_fixes(at.monotonic_ns);
  Tick out;
  out.number = ++ticks_;
  out.utc_ns = at.utc_ns;
  out.view = book_.view(at.monotonic_ns);
  out.view.utc_ns = at.utc_ns;
  out.view.domain = options_.domain;
  out.view.window_s = to_seconds(at.monotonic_ns - began_ns_);
  out.trust = status::judge_trust(out.view, options_.fresh_s);
  out.nav_latency_s = nav_latency_s_;
  for (const auto& [name, source] : sources_) {
    SourceLine line = source.line;
    line.since_heard_s = to_seconds(at.monotonic_ns - source.heard_ns);
    if (source.used_ns != 0) line.since_used_s = to_seconds(at.monotonic_ns - source.used_ns);
    out.sources.push_back(line);
  }
  // What changes once a second is said once a second.
  if (ticks_ % kServicesEvery == 1) {
    for (const auto& [name, line] : services_) out.services.push_back(line);
  }
  if (routes_.take_changed() || ticks_ % kServicesEvery == 1) out.routes = routes_.lines(at);
  out.beacons = beacons_.lines(at);
  const auto states = std::min<std::size_t>(detail_.count, NavDetail::kMaxStates);
  for (std::size_t i = 0; i < states; ++i) {
    if (detail_.states[i].name.view().starts_with("current_")) out.current.push_back(detail_.states[i]);
  }
  out.fresh = history_.commit();
  for (const VerdictSeries& series : history_.verdicts()) {
    VerdictSeries head{series.sensor, series.model, series.source, Ring<VerdictRow>(1), 0};
    out.fresh_series.push_back(std::move(head));
  }
  const NavDetail& detail = history_.detail_names();
  out.detail_count = detail.count;
  if (out.fresh.detail_renamed) {
    for (std::size_t i = 0; i < detail.count; ++i) out.detail_names.push_back(detail.states[i].name);
  }
  return out;
}

}  // namespace fathom::console

#include "estimation/smoothing/smoother.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "estimation/engine/output.hpp"
#include "estimation/smoothing/filter_log.hpp"

namespace fathom::estimation {
namespace {

// 5 s at 100 Hz: what the way back holds in memory at once.
constexpr std::size_t kSegment = 512;

EngineConfig checked(const EngineConfig& config) {
  const std::string complaint = config.validate();
  if (!complaint.empty()) throw std::invalid_argument(complaint);
  return config;
}

Judgement refusal(VerdictKind kind) {
  Judgement out;
  out.kind = kind;
  return out;
}

/// What is recorded is judged once.
Verdict final_verdict(const SampleHeader& header, SourceKind source, const Judgement& judgement) {
  Verdict out = verdict_of(header, source, judgement);
  out.is_final = true;
  return out;
}

}  // namespace

/// What the filter did in some ticks, and the navigator after each of them.
struct Smoother::Segment {
  explicit Segment(int states) : log(states) {}

  FilterLog log;
  std::vector<std::size_t> ends;  ///< of each tick in the log
  std::vector<Navigator> navigators;
};

// What the filter only considers the way back may as well find: it rests on gains that are optimal.
Smoother::Smoother(const EngineConfig& config)
    : setup_(checked(config), StateIndex::Considered::found), intake_(setup_) {
  for (int i = 0; i < kNavStates; ++i) shown_states_.push_back(i);
  if (const int surface = setup_.index.of(Group::surface_altitude); surface >= 0)
    shown_states_.push_back(surface);
}

void Smoother::refuse(const SampleHeader& header, SourceKind source, VerdictKind kind) {
  refused_.push_back(final_verdict(header, source, refusal(kind)));
}

void Smoother::add(const ImuSample& sample) {
  const ImuPreprocessor::Result result = intake_.take(sample);
  if (result.outcome == ImuPreprocessor::Outcome::refused)
    return refuse(sample.header, SourceKind::imu, result.refusal);
  if (result.outcome == ImuPreprocessor::Outcome::rebased) ++axis_;
  ticks_.push_back({result.outcome, axis_, sample.header.stamp_ns, sample.header.received_ns,
                    result.unobserved_s, result.step});
}

void Smoother::take(const EventSample& sample, SourceKind source) {
  const SampleHeader& header = header_of(sample);
  const auto& sensors = setup_.config.sensors;
  const auto found = std::find_if(sensors.begin(), sensors.end(), [&](const SensorConfig& one) {
    return one.kind == source && header.sensor == Name(one.sensor);
  });
  if (found == sensors.end()) return refuse(header, source, VerdictKind::source_disabled);
  if (!sound_stamp(header.stamp_ns)) return refuse(header, source, VerdictKind::out_of_range);
  Event& event = events_.emplace_back();
  event.axis = axis_;
  Measurement& one = event.measurement;
  one.stamp_ns = header.stamp_ns - from_seconds(found->latency_s);
  one.source = source;
  one.sensor = static_cast<int>(found - sensors.begin());
  one.sequence = header.sequence;
  one.sample = sample;
}

std::string Smoother::add(const Command& command) {
  if (std::string why = objection_to(command, setup_.config); !why.empty()) return why;
  Event& event = events_.emplace_back();
  event.axis = axis_;
  Measurement& one = event.measurement;
  one.stamp_ns = command.header.stamp_ns;
  one.command = true;
  one.source = SourceKind::imu;
  one.sequence = order_number(command);
  one.sample = command;
  return {};
}

void Smoother::sort_events() {
  const auto key = [](const Event& event) { return std::make_tuple(event.axis, event.measurement.key()); };
  std::stable_sort(events_.begin(), events_.end(),
                   [&](const Event& a, const Event& b) { return key(a) < key(b); });
}

void Smoother::tell(const Event& event, const Judgement& judgement, const Output& output) {
  const Measurement& one = event.measurement;
  if (one.command) {
    if (output.outcome) output.outcome(outcome_of(std::get<Command>(one.sample), judgement, false));
  } else if (output.verdict) {
    output.verdict(final_verdict(one.header(), one.source, judgement));
  }
}

void Smoother::advance(Snapshot& at, const Output& output) const {
  const Tick& tick = ticks_[at.tick++];
  if (tick.outcome != ImuPreprocessor::Outcome::step) {
    // What was measured on the axis before and has not acted cannot act any more.
    for (; at.event < events_.size(); ++at.event) {
      const Event& event = events_[at.event];
      const bool first = tick.outcome == ImuPreprocessor::Outcome::first;
      if (event.axis == tick.axis && event.measurement.stamp_ns > tick.stamp_ns) break;
      tell(event, refusal(first ? VerdictKind::not_aligned : VerdictKind::late), output);
    }
    at.navigator.rebase(tick.stamp_ns, tick.unobserved_s);
  } else {
    for (; at.event < events_.size(); ++at.event) {
      const Event& event = events_[at.event];
      const Measurement& one = event.measurement;
      if (event.axis != tick.axis || one.stamp_ns > tick.step.to_ns) break;
      const bool again = at.event > 0 && events_[at.event - 1].axis == event.axis &&
                         events_[at.event - 1].measurement.key() == one.key();
      if (again) {
        tell(event, refusal(VerdictKind::duplicate), output);
        continue;
      }
      at.navigator.advance(tick.step, one.stamp_ns);
      tell(event, at.navigator.apply(one), output);
    }
    at.navigator.advance(tick.step, tick.step.to_ns);
    at.navigator.finish(tick.step);
  }
  if (start_ && !at.started && tick.stamp_ns >= start_->stamp_ns) {
    at.navigator.start(*start_, tick.stamp_ns);
    at.started = true;
  }
}

void Smoother::fill(const Navigator& navigator, std::size_t tick, NavState& out) const {
  out.header.vehicle = std::string_view(setup_.config.vehicle);
  out.header.sensor = std::string_view(setup_.config.sensor);
  out.header.stamp_ns = ticks_[tick].stamp_ns;
  out.header.received_ns = ticks_[tick].received_ns;
  out.header.sequence = tick + 1;
  estimation::fill(setup_, navigator, out);
}

void Smoother::smooth(const Snapshot& from, std::size_t end, Segment& segment, Adjoint& adjoint,
                      const std::function<void(const NavState&)>& smoothed) const {
  Snapshot at = from;
  segment.log.clear();
  segment.ends.assign(1, 0);
  segment.navigators.clear();
  at.navigator.record_to(&segment.log);
  while (at.tick < end) {
    advance(at, {});
    segment.ends.push_back(segment.log.size());
    segment.navigators.push_back(at.navigator);
  }
  NavState nav;
  std::array<double, kMaxStates> x{};
  for (std::size_t tick = end; tick-- > from.tick;) {
    const std::size_t place = tick - from.tick;
    Navigator& navigator = segment.navigators[place];
    navigator.record_to(nullptr);
    if (navigator.navigating() && smoothed) {
      FilterState state = navigator.state();
      ErrorFilter filter = navigator.filter();
      adjoint.smoothed_error(filter, x);
      remove_error(x, filter.size(), state);
      adjoint.smooth_covariance(shown_states_, filter);
      navigator.replace(state, filter);
    }
    fill(navigator, tick, nav);
    if (smoothed) smoothed(nav);
    segment.log.back_through(segment.ends[place + 1], segment.ends[place], adjoint);
  }
}

void Smoother::run(const Output& output) {
  sort_events();
  if (output.verdict) std::for_each(refused_.begin(), refused_.end(), output.verdict);
  const auto progress = [&](std::size_t done) {
    if (output.progress)
      output.progress(static_cast<double>(done) / (3.0 * static_cast<double>(ticks_.size())));
  };
  std::vector<Snapshot> snapshots;
  Snapshot at{0, 0, false, Navigator(setup_)};
  NavState nav;
  while (at.tick < ticks_.size()) {
    if (at.tick % kSegment == 0) {
      snapshots.push_back(at);
      progress(at.tick);
    }
    advance(at, output);
    if (!output.filtered) continue;
    fill(at.navigator, at.tick - 1, nav);
    output.filtered(nav);
  }
  for (; at.event < events_.size(); ++at.event)
    tell(events_[at.event], refusal(VerdictKind::from_the_future), output);
  if (output.detail && !ticks_.empty()) {
    NavDetail detail;
    estimation::fill(setup_, at.navigator, detail);
    output.detail(detail);
  }

  Segment segment(setup_.index.size());
  Adjoint adjoint(setup_.index.size());
  for (std::size_t end = ticks_.size(); !snapshots.empty(); snapshots.pop_back()) {
    smooth(snapshots.back(), end, segment, adjoint, output.smoothed);
    end = snapshots.back().tick;
    progress(3 * ticks_.size() - 2 * end);
  }
}

}  // namespace fathom::estimation

#include "explain/history.hpp"

#include <algorithm>
#include <cmath>

#include "samples/alignment/help.hpp"

namespace fathom::explain {
namespace {

constexpr DurationNs kStateStep_ns = kNsPerSecond / 10;
constexpr DurationNs kCutStep_ns = 5 * kNsPerSecond;
/// What is said again within it is the same.
constexpr DurationNs kSame_ns = 30 * kNsPerSecond;
constexpr std::size_t kMostOpen = 65'536;

template <class List>
bool same_conditions(const List& a, const List& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [](const auto& x, const auto& y) { return x.name == y.name; });
}

std::string text_of(const std::array<char, 128>& text) {
  return {text.begin(), std::find(text.begin(), text.end(), '\0')};
}

}  // namespace

bool History::begin(const SampleHeader& header, const Arrival& arrival) {
  if (!sound_stamp(arrival.log_ns) || arrival.log_ns <= 0) return false;
  if (!sound_stamp(header.stamp_ns) || !sound_stamp(header.received_ns)) return false;
  if (vehicle_.empty()) vehicle_ = header.vehicle;
  if (header.vehicle != vehicle_) return false;
  if (from_ns_ == 0) {
    from_ns_ = arrival.log_ns;
    cut_ns_ = arrival.log_ns;
  }
  to_ns_ = std::max(to_ns_, arrival.log_ns);
  if (to_ns_ - cut_ns_ >= kCutStep_ns) {
    cut_ns_ = to_ns_;
    forget();
  }
  return true;
}

template <class Row, class At>
void History::cut(std::deque<Row>& rows, At at) {
  while (!rows.empty() && at(rows.front()) < from_ns_) rows.pop_front();
  for (; rows.size() > limits_.rows; ++forgotten_) {
    from_ns_ = std::max(from_ns_, at(rows.front()));
    rows.pop_front();
  }
}

void History::forget() {
  if (to_ns_ - from_ns_ > limits_.span_ns) from_ns_ = to_ns_ - limits_.span_ns;
  const auto by_arrival = [](const auto& row) { return row.log_ns; };
  cut(states_, by_arrival);
  const std::size_t before = verdicts_.size();
  cut(verdicts_, by_arrival);
  verdicts_gone_ += before - verdicts_.size();
  cut(fixes_, [](const FixRow& row) { return row.stamp_ns; });
  cut(dvl_, [](const DvlRow& row) { return row.stamp_ns; });
  cut(alarms_, by_arrival);
  cut(noise_, by_arrival);
  cut(biases_, by_arrival);
  cut(orders_, by_arrival);
  for (Stream& stream : streams_) {
    cut(stream.seconds, [](const Second& row) { return row.at_ns; });
    cut(stream.pauses, [](const Pause& row) { return row.to_ns; });
  }
  // What holds until something new is said stays, whatever its age: the last of each.
  while (alignment_.size() > 1 && (alignment_[1].log_ns < from_ns_ || alignment_.size() > limits_.rows))
    alignment_.pop_front();
  while (runs_.size() > kMostNames) runs_.pop_front();
  while (life_.size() > kMostNames) life_.pop_front();
  if (open_.size() > kMostOpen) open_.clear();
  std::erase_if(open_, [&](const auto& one) { return one.second < verdicts_gone_; });
}

std::optional<std::uint32_t> History::stream_of(SourceKind kind, const Name& sensor) {
  for (std::size_t i = 0; i < streams_.size(); ++i)
    if (streams_[i].kind == kind && streams_[i].sensor == sensor) return static_cast<std::uint32_t>(i);
  if (streams_.size() >= kMostStreams) return std::nullopt;
  Stream& fresh = streams_.emplace_back();
  fresh.kind = kind;
  fresh.sensor = sensor;
  return static_cast<std::uint32_t>(streams_.size() - 1);
}

std::uint32_t History::number_of(const std::string& name) {
  if (names_.empty()) names_.emplace_back("?");
  const auto found = numbers_.find(name);
  if (found != numbers_.end()) return found->second;
  if (names_.size() >= kMostNames) return 0;
  names_.push_back(name);
  return numbers_[name] = static_cast<std::uint32_t>(names_.size() - 1);
}

std::uint32_t History::writer_of(const Arrival& arrival) {
  if (writers_.empty()) writers_.emplace_back("?", "");
  std::pair<std::string, std::string> key(arrival.writer, arrival.process);
  const auto found = writer_numbers_.find(key);
  if (found != writer_numbers_.end()) return found->second;
  if (writers_.size() >= kMostNames) return 0;
  // The first digits of an identity tell the vendor and the host, which are the same for all.
  const std::string tail = arrival.process.size() > 8 ? arrival.process.substr(8, 8) : arrival.process;
  const std::string who = arrival.writer.empty() ? "a writer" : arrival.writer;
  writers_.emplace_back(tail.empty() ? who : who + " (" + tail + ")", arrival.process);
  return writer_numbers_[key] = static_cast<std::uint32_t>(writers_.size() - 1);
}

void History::heard(SourceKind kind, const SampleHeader& header, const Arrival& arrival) {
  const auto number = stream_of(kind, header.sensor);
  if (!number) return;
  Stream& stream = streams_[*number];
  const std::uint32_t writer = writer_of(arrival);
  const double age_s = to_seconds(header.received_ns - header.stamp_ns);
  const double bus_s = to_seconds(arrival.log_ns - header.received_ns);
  const TimeNs second_ns = arrival.log_ns - arrival.log_ns % kNsPerSecond;
  Second* second = nullptr;
  for (auto row = stream.seconds.rbegin(); row != stream.seconds.rend() && row->at_ns == second_ns; ++row)
    if (row->writer == writer) second = &*row;
  if (second == nullptr) {
    Second& fresh = stream.seconds.emplace_back();
    fresh.at_ns = second_ns;
    fresh.writer = writer;
    fresh.age_low_s = fresh.age_high_s = age_s;
    fresh.bus_low_s = bus_s;
    second = &fresh;
  }
  ++second->count;
  second->age_low_s = std::min(second->age_low_s, age_s);
  second->age_high_s = std::max(second->age_high_s, age_s);
  second->age_sum_s += age_s;
  second->bus_low_s = std::min(second->bus_low_s, bus_s);
  if (stream.samples++ > 0) {
    if (arrival.log_ns - stream.last_log_ns > Pause::kLeast_ns)
      stream.pauses.push_back({stream.last_log_ns, arrival.log_ns, header.stamp_ns - stream.last_stamp_ns});
    const double step_s = to_seconds(header.stamp_ns - stream.last_stamp_ns);
    const double arrival_s = to_seconds(header.received_ns - stream.last_received_ns);
    if (step_s > second->stamp_step_s) {
      second->stamp_step_s = step_s;
      second->stamp_before_ns = stream.last_stamp_ns;
      second->arrival_after_s = arrival_s;
    }
    second->stamp_step_low_s = std::min(second->stamp_step_low_s, step_s);
    second->arrival_step_s = std::max(second->arrival_step_s, arrival_s);
  }
  stream.last_stamp_ns = header.stamp_ns;
  stream.last_received_ns = header.received_ns;
  stream.last_log_ns = arrival.log_ns;
}

void History::fix(const GpsSample& sample) {
  const auto number = stream_of(SourceKind::gps, sample.header.sensor);
  if (!number) return;
  FixRow& row = fixes_.emplace_back();
  row.stamp_ns = sample.header.stamp_ns;
  row.stream = *number;
  row.fix = sample.fix;
  row.latitude_rad = sample.latitude_rad;
  row.longitude_rad = sample.longitude_rad;
  row.sigma_m = std::max(sample.position_sigma_N_m[0], sample.position_sigma_N_m[1]);
  row.velocity_N_m_s = {sample.velocity_N_m_s[0], sample.velocity_N_m_s[1]};
  row.jamming = sample.jamming;
  row.spoofing = sample.spoofing;
}

void History::dvl(const DvlSample& sample) {
  const auto number = stream_of(SourceKind::dvl, sample.header.sensor);
  if (!number || sample.mode != DvlMode::bottom) return;
  dvl_.push_back({sample.header.stamp_ns, *number, {sample.velocity_D_m_s[0], sample.velocity_D_m_s[1]}});
}

void History::add(const NavState& state, const Arrival& arrival) {
  if (!begin(state.header, arrival)) return;
  StateRow row;
  row.at_ns = state.header.stamp_ns;
  row.log_ns = arrival.log_ns;
  row.mode = state.mode;
  row.alignment = state.alignment;
  row.resets = state.reset_counter;
  row.instance = number_of(state.header.sensor.str());
  row.writer = writer_of(arrival);
  if (!states_.empty()) {
    const StateRow& last = states_.back();
    const bool same = last.mode == row.mode && last.alignment == row.alignment && last.resets == row.resets &&
                      last.instance == row.instance && last.writer == row.writer;
    const DurationNs step_ns = row.at_ns - last.at_ns;
    if (same && step_ns >= 0 && step_ns < kStateStep_ns) return;
  }
  row.latitude_rad = state.latitude_rad;
  row.longitude_rad = state.longitude_rad;
  row.depth_m = state.depth_m;
  row.velocity_N_m_s = state.velocity_N_m_s;
  row.yaw_rad = state.rpy_rad[2];
  row.sigma_m = std::sqrt(state.position_covariance_N_m2[0] + state.position_covariance_N_m2[4]);
  row.yaw_sigma_rad = state.rpy_sigma_rad[2];
  row.reset_m = std::hypot(state.last_reset_delta_N_m[0], state.last_reset_delta_N_m[1]);
  states_.push_back(row);
}

void History::add(const Verdict& verdict, const Arrival& arrival) {
  if (static_cast<std::size_t>(verdict.kind) >= kVerdictKinds || !begin(verdict.header, arrival)) return;
  const auto stream = stream_of(verdict.source, verdict.header.sensor);
  if (!stream) return;
  const Measurement key{*stream, verdict.header.stamp_ns, verdict.header.sequence};
  VerdictRow* row = nullptr;
  const auto open = open_.find(key);
  if (verdict.revision > 0) {
    // Of a measurement whose first verdict was not heard nothing more is said.
    if (open == open_.end() || open->second < verdicts_gone_) return;
    row = &verdicts_[open->second - verdicts_gone_];
  } else {
    row = &verdicts_.emplace_back();
    row->log_ns = arrival.log_ns;
    if (!verdict.is_final) open_[key] = verdicts_gone_ + verdicts_.size() - 1;
  }
  row->stamp_ns = verdict.header.stamp_ns;
  row->stream = *stream;
  row->model = number_of(verdict.model.str());
  row->kind = verdict.kind;
  row->dimensions = static_cast<std::uint8_t>(std::min<std::uint32_t>(verdict.dimensions, 6));
  row->innovation = verdict.innovation;
  row->sigma = verdict.innovation_sigma;
  row->test_ratio = verdict.test_ratio;
  row->limit = verdict.limit;
  if (verdict.revision > 0 && verdict.is_final) open_.erase(open);
}

void History::noisy(const NoiseFactor& found, TimeNs log_ns) {
  const auto row = std::find_if(noise_.rbegin(), noise_.rend(),
                                [&](const NoiseRow& one) { return one.sensor == found.sensor; });
  if (row == noise_.rend() || log_ns - row->log_ns > kSame_ns) {
    noise_.push_back({std::string(found.sensor), log_ns, log_ns, found.factor});
    return;
  }
  row->log_ns = log_ns;
  row->most = std::max(row->most, found.factor);
}

void History::biased(const FoundBias& found, TimeNs log_ns) {
  const auto row = std::find_if(biases_.rbegin(), biases_.rend(),
                                [&](const BiasRow& one) { return one.last.axis == found.axis; });
  if (row == biases_.rend() || log_ns - row->log_ns > kSame_ns) {
    biases_.push_back({found, log_ns, log_ns});
    return;
  }
  row->log_ns = log_ns;
  row->last = found;
}

void History::add(const AlignmentStatus& status, const Arrival& arrival) {
  if (!begin(status.header, arrival)) return;
  for (const NoiseFactor& one : noise_factors(status)) noisy(one, arrival.log_ns);
  for (const FoundBias& one : found_biases(status)) biased(one, arrival.log_ns);
  AlignmentRow row;
  row.log_ns = arrival.log_ns;
  row.phase = status.phase;
  row.advice = text_of(status.advice);
  for (std::size_t i = 0; i < std::min<std::size_t>(status.condition_count, AlignmentStatus::kMaxConditions);
       ++i)
    if (!status.conditions[i].met) row.unmet.push_back(status.conditions[i]);
  row.start_error_rad = start_heading_error_rad(status);
  if (!alignment_.empty() && alignment_.back().phase == row.phase &&
      alignment_.back().start_error_rad == row.start_error_rad &&
      same_conditions(alignment_.back().unmet, row.unmet)) {
    alignment_.back().unmet = std::move(row.unmet);
    alignment_.back().advice = std::move(row.advice);
    return;
  }
  alignment_.push_back(std::move(row));
}

void History::add(const ServiceStatus& status, const Arrival& arrival) {
  if (!begin(status.header, arrival)) return;
  LifeSign row;
  row.log_ns = arrival.log_ns;
  row.service = number_of(status.header.sensor.str());
  row.host = status.host;
  row.pid = status.pid;
  row.started_ns = status.started_ns;
  row.utc_offset_ns = status.utc_offset_ns;
  row.state = status.state;
  row.text = status.text;
  const auto before = life_last_ns_.find(row.service);
  row.before_ns = before == life_last_ns_.end() ? 0 : before->second;
  life_last_ns_[row.service] = row.log_ns;
  for (auto last = life_.rbegin(); last != life_.rend(); ++last) {
    if (last->service != row.service) continue;
    constexpr DurationNs kSlow_ns = kNsPerSecond / 20;  // clocks drift
    if (row.before_ns > 0 && row.log_ns - row.before_ns > LifeSign::kSilence_ns) break;
    if (last->pid == row.pid && last->started_ns == row.started_ns && last->state == row.state &&
        last->text == row.text && std::abs(last->utc_offset_ns - row.utc_offset_ns) < kSlow_ns)
      return;
    break;
  }
  life_.push_back(std::move(row));
}

void History::add(const Alarm& alarm, const Arrival& arrival) {
  if (!begin(alarm.header, arrival)) return;
  // Alarms are said again and again: a row is a change.
  for (auto last = alarms_.rbegin(); last != alarms_.rend(); ++last) {
    if (last->alarm.alarm != alarm.alarm) continue;
    if (last->alarm.active == alarm.active && last->alarm.severity == alarm.severity &&
        last->alarm.since_ns == alarm.since_ns)
      return;
    break;
  }
  alarms_.push_back({arrival.log_ns, alarm});
}

void History::add(const Command& order, const Arrival& arrival) {
  if (begin(order.header, arrival)) orders_.push_back({arrival.log_ns, order});
}

void History::add(const IntakeRecord& intake, const Arrival& arrival) {
  if (!begin(intake.header, arrival)) return;
  const bool resumed = std::any_of(intake.entries.begin(), intake.entries.end(),
                                   [](const IntakeEntry& one) { return one.kind == IntakeKind::state; });
  const RunRow row{arrival.log_ns, number_of(intake.header.sensor.str()), writer_of(arrival), resumed,
                   intake.first};
  const bool is_known = std::any_of(runs_.begin(), runs_.end(), [&](const RunRow& one) {
    return one.writer == row.writer && one.instance == row.instance;
  });
  if (is_known && !resumed) return;
  runs_.push_back(row);
}

}  // namespace fathom::explain

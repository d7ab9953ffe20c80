// What a history's state follows from, as an archive: the oldest navigator that is held, and the steps and
// events since.
#include <algorithm>
#include <variant>

#include "estimation/engine/history.hpp"
#include "estimation/engine/order.hpp"
#include "estimation/fields/measurement.hpp"
#include "estimation/fields/navigator.hpp"

namespace fathom::estimation {
namespace {

void check_order(archive::Reader& archive, const Measurement& event) {
  const auto* order = std::get_if<Command>(&event.sample);
  archive.expect(order != nullptr && event.sensor == -1 && event.source == SourceKind::imu, "command",
                 "an order that stands for itself");
  if (order == nullptr) return;
  const std::string objection = objection_to(*order);
  archive.expect(objection.empty(), "sample", objection);
}

void check_measurement(archive::Reader& archive, const Setup& setup, const Measurement& event) {
  const auto& sensors = setup.config.sensors;
  const bool configured = event.sensor >= 0 && event.sensor < static_cast<int>(sensors.size());
  archive.expect(configured, "sensor", "one of the configuration's");
  if (!configured) return;
  const SensorConfig& sensor = sensors[static_cast<std::size_t>(event.sensor)];
  archive.expect(event.source == sensor.kind, "source", "the configured kind of the sensor");
  archive.expect(source_of(event.sample) == event.source, "sample", "one of its source");
  const SampleHeader& header = event.header();
  archive.expect(header.sensor == Name(sensor.sensor), "sample.sensor", sensor.sensor);
  archive.expect(sound_stamp(header.stamp_ns) && header.sequence == event.sequence &&
                     event.stamp_ns == acting_of(setup, header, event.sensor),
                 "stamp_ns", "that of its sample less the latency, or when a late one was given");
}

}  // namespace

/// All that is read before anything is taken over.
struct History::Candidate {
  explicit Candidate(const Setup& setup) : navigator(setup), past(setup.index.size()) {}

  std::uint64_t base_step = 0;  ///< steps that the navigator has taken
  Navigator navigator;
  std::vector<ImuStep> steps;       ///< those that follow
  std::vector<Measurement> events;  ///< later than the navigator, in their order
  Past::Candidate past;             ///< of the navigator
};

void History::layout(archive::Layout& archive) const {
  std::uint64_t count = 0;
  const ImuStep step;
  const Measurement event;
  archive("base_step", count);
  archive("core", present());
  archive("steps", count);
  archive.element("steps", 0, step);
  archive("events", count);
  archive.element("events", 0, event);
  if (past_.on() && archive.since(7)) past_.layout(archive);
}

void History::write(archive::Writer& archive) const {
  // Snapshots behind the second navigator are the first one's, and lack what the second is making up for.
  const bool second = catching_up_ && catching_.now_ns() < marks_[0].now_ns;
  const std::uint64_t base_step = second ? caught_up_step_ : marks_[0].after_step;
  const Navigator& navigator = second ? catching_ : snapshot(0);
  archive("base_step", base_step);
  archive("core", navigator);
  const std::uint64_t steps = steps_done_ - base_step;
  archive("steps", steps);
  for (std::uint64_t step = base_step; step < steps_done_; ++step) {
    const ImuStep& one = steps_[step % steps_.size()];
    archive.element("steps", step - base_step, one);
  }
  // Older ones have acted for good and have their final verdict.
  const std::size_t first = first_after(navigator.now_ns());
  const std::uint64_t events = event_count_ - first;
  archive("events", events);
  for (std::size_t rank = first; rank < event_count_; ++rank) {
    const Measurement& one = pool_[order_[rank]];
    archive.element("events", rank - first, one);
  }
  if (past_.on()) past_.write(second ? catching_leg_ : legs_[marks_[0].place], archive);
}

void History::read_steps(archive::Reader& archive, Candidate& out) const {
  std::uint64_t count = 0;
  archive("steps", count);
  archive.expect(count <= steps_.size(), "steps", "at most " + std::to_string(steps_.size()));
  const ImuConfig& imu = setup_->config.imu;
  // Along any axis, over an interval and what its increments may cover beside it.
  const double longest_s = 4.0 * imu.lost_gap_s;
  TimeNs before_ns = out.navigator.now_ns();
  for (std::uint64_t i = 0; i < count && archive.good(); ++i) {
    ImuStep& step = out.steps.emplace_back();
    archive.element("steps", i, step);
    const Increments& in = step.increments;
    archive.expect(step.from_ns == before_ns && step.to_ns > step.from_ns, "steps", "one behind the other");
    if (!archive.good()) return;
    const double dt_s = static_cast<double>(step.to_ns - step.from_ns) * 1e-9;
    archive.expect(in.dt_s == dt_s && dt_s <= imu.lost_gap_s && (step.gap_s == 0.0 || step.gap_s == dt_s),
                   "steps.dt_s", "the time between two samples that follow each other");
    archive.expect(in.dtheta_rad.norm() <= imu.max_rate_rad_s * longest_s &&
                       in.dtheta_before_rad.norm() <= imu.max_rate_rad_s * longest_s &&
                       in.dv_m_s.norm() <= imu.max_specific_force_m_s2 * longest_s &&
                       in.dv_before_m_s.norm() <= imu.max_specific_force_m_s2 * longest_s,
                   "steps.increments", "what the inertial unit can measure");
    before_ns = step.to_ns;
  }
}

void History::read_events(archive::Reader& archive, Candidate& out) const {
  std::uint64_t count = 0;
  archive("events", count);
  archive.expect(count <= order_.size(), "events", "at most " + std::to_string(order_.size()));
  const TimeNs newest_ns = out.steps.empty() ? out.navigator.now_ns() : out.steps.back().to_ns;
  for (std::uint64_t i = 0; i < count && archive.good(); ++i) {
    Measurement event;
    archive.element("events", i, event);
    if (!archive.good()) return;
    archive.open("events", i);
    const TimeNs latest_ns = newest_ns + future_tolerance_ns(event);
    archive.expect(event.stamp_ns > out.navigator.now_ns() && event.stamp_ns <= latest_ns, "stamp_ns",
                   "an instant within the horizon");
    archive.expect(out.events.empty() || out.events.back().key() < event.key(), "stamp_ns",
                   "one behind the other");
    if (event.command) {
      check_order(archive, event);
    } else {
      check_measurement(archive, *setup_, event);
    }
    archive.close();
    out.events.push_back(event);
  }
}

std::string History::read(archive::Reader& archive, TimeNs newest_ns, VerdictSink& sink) {
  Candidate found(*setup_);
  archive("base_step", found.base_step);
  archive("core", found.navigator);
  if (archive.good()) read_steps(archive, found);
  if (archive.good()) read_events(archive, found);
  if (archive.good() && past_.on() && archive.since(7))
    past_.read(archive, found.navigator.now_ns(), found.past);
  archive.expect_end();
  archive.expect(newest_ns == (found.steps.empty() ? found.navigator.now_ns() : found.steps.back().to_ns),
                 "newest_ns", "the end of the last step");
  if (!archive.good()) return archive.complaint();
  take_over(found, sink);
  return {};
}

void History::take_over(const Candidate& found, VerdictSink& sink) {
  forget();  // what becomes of those events follows from the state that is taken over
  present() = found.navigator;
  if (past_.on()) past_.take_over(found.past, present_leg());
  const std::uint64_t target = found.base_step + found.steps.size();
  for (std::uint64_t step = found.base_step; step < target; ++step)
    steps_[step % steps_.size()] = found.steps[step - found.base_step];
  for (std::size_t rank = 0; rank < order_.size(); ++rank) order_[rank] = static_cast<std::uint16_t>(rank);
  std::copy(found.events.begin(), found.events.end(), pool_.begin());
  event_count_ = found.events.size();
  for (std::size_t rank = 0; rank < event_count_; ++rank) {
    judgements_[rank] = {};  // until it acts again
    judgements_[rank].kind = pool_[rank].said;
    // Those that have their final verdict are the oldest.
    if (settled_count_ == rank && (pool_[rank].settled || pool_[rank].command)) ++settled_count_;
  }
  steps_done_ = found.base_step;
  started_ = true;
  save(sink);
  repeat_until(target, sink);
}

}  // namespace fathom::estimation

#include "demo/observer.hpp"

#include "bus/reader.hpp"

namespace fathom::demo {

struct Observer::Readers {
  /// A handler that writes what it hears down, under the lock.
  template <class Sample>
  static auto note(Observer& self) {
    return [&self](const Sample& sample, const bus::SampleInfo&) {
      const std::lock_guard lock(self.mutex_);
      self.record_.add(sample);
    };
  }

  Readers(Observer& self, bus::Participant& participant)
      : truth(participant, note<Truth>(self)),
        nav(participant,
            [&self](const NavState& state, const bus::SampleInfo&) {
              const double latency_s = to_seconds(self.clock_.utc_ns() - state.header.received_ns);
              const std::lock_guard lock(self.mutex_);
              self.record_.add(state, latency_s * 1e6 / self.clock_.rate());
            }),
        gps(participant, note<GpsSample>(self)),
        monitor(participant, note<MonitorStatus>(self)),
        service(participant,
                [&self](const ServiceStatus& status, const bus::SampleInfo&) {
                  const TimeNs now_ns = self.clock_.monotonic_ns();
                  const std::lock_guard lock(self.mutex_);
                  self.record_.add(status, now_ns);
                }),
        alignment(participant, note<AlignmentStatus>(self)),
        verdict(participant, note<Verdict>(self)),
        alarm(participant, note<Alarm>(self)) {}

  bus::Reader<Truth> truth;
  bus::Reader<NavState> nav;
  bus::Reader<GpsSample> gps;
  bus::Reader<MonitorStatus> monitor;
  bus::Reader<ServiceStatus> service;
  bus::Reader<AlignmentStatus> alignment;
  bus::Reader<Verdict> verdict;
  bus::Reader<Alarm> alarm;
};

Observer::Observer(bus::Participant& participant, const Clock& clock, const RunRecord::Options& options)
    : clock_(clock),
      record_(options, clock.utc_ns()),
      readers_(std::make_unique<Readers>(*this, participant)) {}

Observer::~Observer() = default;

Observation Observer::look() const {
  const std::lock_guard lock(mutex_);
  return record_.look(clock_.utc_ns(), clock_.monotonic_ns());
}

}  // namespace fathom::demo

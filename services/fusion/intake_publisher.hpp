#pragma once

#include <mutex>

#include "bus/writer.hpp"
#include "fusion/checkpoint/start.hpp"
#include "fusion/intake/intake_list.hpp"
#include "host/service_host.hpp"

namespace fathom::fusion {

/// Publishes what the engine was given, in its order, so that a recording can prove that the states follow
/// from it.
class IntakePublisher {
 public:
  /// `mutex` guards the engine, which began with `start`: that comes before all that it is given.
  IntakePublisher(host::ServiceHost& host, std::mutex& mutex, const Resumption& start)
      : host_(host), mutex_(mutex), writer_(host.participant()) {
    batch_.entries.reserve(IntakeRecord::kMostEntries);
    if (start.resumed) add_state(start.stamp_ns, start.digest, Name(host.name()));
  }

  /// Given to the engine just now. `again`: what the engine says of it is not published. Mutex held.
  void add(const Arrival& arrival, bool again = false) { list_.add(arrival, again, now_ns()); }
  void add(const Command& order, bool again = false) { list_.add(order, again, now_ns()); }
  /// The engine went on from this state just now. Mutex held.
  void add_state(TimeNs stamp_ns, std::uint64_t digest, const Name& saved_by) {
    list_.add_state(stamp_ns, digest, saved_by, now_ns());
  }
  /// The engine gets nothing more. Mutex held.
  void add_end() { list_.add_end(now_ns()); }

  /// Publishes what waits, when it is enough, old enough or all is wanted. Mutex not held.
  void publish(bool all = false);

 private:
  [[nodiscard]] TimeNs now_ns() const { return host_.clock().monotonic_ns(); }

  host::ServiceHost& host_;
  std::mutex& mutex_;
  IntakeList list_;  // guarded by the engine's mutex
  std::mutex publishing_;
  IntakeRecord batch_;  // guarded by `publishing_`, which is locked before the engine's
  std::uint64_t sequence_ = 0;
  bus::Writer<IntakeRecord> writer_;
};

}  // namespace fathom::fusion

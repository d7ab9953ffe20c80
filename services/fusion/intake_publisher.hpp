#pragma once

#include <mutex>

#include "bus/writer.hpp"
#include "fusion/intake/arrival.hpp"
#include "host/service_host.hpp"
#include "samples/command.hpp"
#include "samples/status/intake.hpp"

namespace fathom::fusion {

/// Publishes what the engine was given, in its order, so that a recording can prove that the states follow
/// from it.
class IntakePublisher {
 public:
  IntakePublisher(host::ServiceHost& host, std::mutex& mutex)
      : host_(host), mutex_(mutex), writer_(host.participant()) {}

  /// The run has a state that it did not make itself. Mutex held.
  void resumed() { resumed_ = true; }
  /// Given to the engine just now. Mutex held.
  void add(const Arrival& arrival);
  void add(const Command& order);
  /// Publishes what waits, when it is enough, old enough or all is wanted. Mutex not held.
  void publish(bool all = false);

 private:
  void add(IntakeEntry entry);

  host::ServiceHost& host_;
  std::mutex& mutex_;  ///< guards what follows up to the writer
  std::vector<IntakeEntry> waiting_;
  TimeNs oldest_ns_ = 0;
  std::uint64_t published_ = 0;
  std::uint64_t sequence_ = 0;
  bool resumed_ = false;
  bus::Writer<IntakeRecord> writer_;
};

}  // namespace fathom::fusion

#pragma once

#include <memory>
#include <mutex>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "demo/run_record.hpp"

namespace fathom::demo {

/// Listens to the whole vehicle network, as a guidance program and a referee with the truth would.
class Observer {
 public:
  /// `clock` must outlive the observer. Throws bus::BusError.
  Observer(bus::Participant& participant, const Clock& clock, const RunRecord::Options& options);
  ~Observer();

  [[nodiscard]] Observation look() const;

 private:
  struct Readers;

  const Clock& clock_;
  mutable std::mutex mutex_;
  RunRecord record_;
  std::unique_ptr<Readers> readers_;  ///< last: gone before what its handlers touch
};

}  // namespace fathom::demo

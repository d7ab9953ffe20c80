#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "base/clock.hpp"
#include "blackbox/options.hpp"
#include "blackbox/queue.hpp"
#include "blackbox/store.hpp"

namespace fathom::blackbox {

/// Brings samples to the disk on a thread of its own. Nobody who puts something in waits for the disk. Files
/// of an earlier run that were not closed are closed first.
class Recorder {
 public:
  using Say = Store::Say;

  /// `clock` is the vehicle's and outlives this. `say` is called on the disk's thread.
  Recorder(Options options, const Clock& clock, Say say);
  /// Everything that was put in is written, and the file is closed.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  [[nodiscard]] Queue& queue();
  [[nodiscard]] StoreCounts counts() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::blackbox

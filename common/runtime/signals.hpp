#pragma once

#include <memory>

#include "base/time.hpp"

namespace fathom::runtime {

/// Blocks SIGINT and SIGTERM in this thread and in all that it starts from now on, so that only a StopSignal
/// sees them, and ignores SIGPIPE. First thing in main, before any thread.
void block_stop_signals();

/// Waits for the end of a service: a signal, or a request from inside. Needs block_stop_signals().
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  enum class Woken { timeout, signal, request };
  /// Returns at the latest after `host_ns` of the host's time.
  [[nodiscard]] Woken wait(DurationNs host_ns);
  /// Makes the present or next wait() return `request`. Any thread.
  void wake();

 private:
  int signals_ = -1;
  int wake_ = -1;
};

}  // namespace fathom::runtime

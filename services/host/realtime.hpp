#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/common_config.hpp"

namespace fathom::host {

/// What real-time scheduling and locked memory need of the kernel. Tests put answers of their own here.
struct RealtimeCalls {
  /// SCHED_FIFO at this priority for the calling thread. Returns 0 or errno.
  std::function<int(int priority)> set_fifo;
  /// RLIMIT_RTPRIO: the highest priority that may be asked for without CAP_SYS_NICE.
  std::function<std::uint64_t()> priority_limit;
  /// Whether memory may be locked without bound. With a bound, what is mapped beyond it later would fail.
  std::function<bool()> may_lock_all;
  /// RLIMIT_MEMLOCK in bytes.
  std::function<std::uint64_t()> lock_limit_bytes;
  /// Locks what is mapped now, and what will be as it is touched. Returns 0 or errno.
  std::function<int()> lock_all;
};

/// Those of this kernel.
[[nodiscard]] RealtimeCalls kernel_calls();

/// Asks for what `config` wants: SCHED_FIFO for the calling thread, which every thread started from it
/// inherits (std::thread and Fast DDS leave POSIX's inheritance as it is), and locked memory for the process.
/// Returns a warning for each thing refused: what, why, and the remedy, short enough for a
/// life sign. The service goes on without it.
[[nodiscard]] std::vector<std::string> apply_realtime(const config::RealtimeConfig& config,
                                                      const RealtimeCalls& calls = kernel_calls());

}  // namespace fathom::host

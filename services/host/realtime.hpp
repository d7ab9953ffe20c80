#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "config/common_config.hpp"

namespace fathom::host {

/// The calls of the kernel for real-time scheduling and locked memory. Tests put in answers of their own.
struct RealtimeCalls {
  /// SCHED_FIFO at this priority for the calling thread. Returns 0 or errno.
  std::function<int(int priority)> set_fifo;
  /// RLIMIT_RTPRIO: the highest priority that may be asked for without CAP_SYS_NICE.
  std::function<std::uint64_t()> priority_limit;
  /// Whether memory may be locked without bound. With a bound, later mappings beyond it would fail.
  std::function<bool()> may_lock_all;
  /// RLIMIT_MEMLOCK in bytes.
  std::function<std::uint64_t()> lock_limit_bytes;
  /// Locks the present mappings now, and later ones when they are touched. Returns 0 or errno.
  std::function<int()> lock_all;
};

/// The calls of this kernel.
[[nodiscard]] RealtimeCalls kernel_calls();

/// Asks the kernel for the scheduling and memory of `config`: SCHED_FIFO for the calling thread and locked
/// memory for the process. Every thread that is started from the calling one inherits SCHED_FIFO, because
/// std::thread and Fast DDS leave POSIX's inheritance as it is. Returns a warning for each refusal, with the
/// reason and the remedy, short enough for a life sign. The service goes on without what was refused.
[[nodiscard]] std::vector<std::string> apply_realtime(const config::RealtimeConfig& config,
                                                      const RealtimeCalls& calls = kernel_calls());

}  // namespace fathom::host

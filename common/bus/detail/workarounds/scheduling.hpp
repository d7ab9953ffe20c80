#pragma once

#include <cstdint>

namespace fathom::bus::detail {

/// How the kernel schedules a thread.
struct Scheduling {
  int policy = 0;
  int priority = 0;  ///< of SCHED_FIFO and SCHED_RR, else 0
};

/// While it lives, threads that the calling thread starts are those of a participant's chores: heartbeats,
/// deadlines, discovery. They give way to threads that carry samples. With every sample that is written or
/// received a timer begins anew, whose thread, woken by that, would otherwise take the processor from the one
/// that is about to send, and then wait for the locks it holds. SCHED_OTHER becomes SCHED_BATCH, which does
/// not preempt; a real-time priority above 1 falls by one. Where the kernel refuses, nothing changes.
class ScopedChores {
 public:
  ScopedChores();
  ~ScopedChores();
  ScopedChores(const ScopedChores&) = delete;
  ScopedChores& operator=(const ScopedChores&) = delete;

  /// Of the calling thread before.
  [[nodiscard]] const Scheduling& before() const { return before_; }

 private:
  Scheduling before_;
  bool changed_ = false;
};

/// As long as a thread that carries samples may go on while another waits, under SCHED_OTHER.
inline constexpr std::uint64_t kTurn_ns = 500'000;

/// The calling thread, if it is SCHED_OTHER, asks for turns of kTurn_ns: from Linux 6.12 on a thread that
/// wakes takes the processor from one with longer turns. Before, and where the kernel refuses, nothing
/// changes. To be called with each sample; the first call counts.
void ask_for_short_turns();

/// The calling thread carries samples: from its first call on it is scheduled as told, with short turns. To
/// be called with each sample.
void carry_samples(const Scheduling& as);

}  // namespace fathom::bus::detail

#pragma once

#include <cstdint>

namespace fathom::bus::detail {

/// How the kernel schedules a thread.
struct Scheduling {
  int policy = 0;
  int priority = 0;  ///< of SCHED_FIFO and SCHED_RR, else 0
};

/// A scope in which the calling thread starts the threads for a participant's chores: heartbeats, deadlines,
/// discovery. Those threads give way to threads that carry samples. Without that, each sample restarts a
/// timer, whose thread wakes, takes the processor from the thread that is about to send, and then waits for
/// the locks of that thread. SCHED_OTHER becomes SCHED_BATCH, which does not preempt. A real-time priority
/// above 1 falls by one. Where the kernel refuses, nothing changes.
class ScopedChores {
 public:
  ScopedChores();
  ~ScopedChores();
  ScopedChores(const ScopedChores&) = delete;
  ScopedChores& operator=(const ScopedChores&) = delete;

  /// The scheduling of the calling thread before.
  [[nodiscard]] const Scheduling& before() const { return before_; }

 private:
  Scheduling before_;
  bool changed_ = false;
};

/// How long a thread that carries samples may run while another one waits, under SCHED_OTHER.
inline constexpr std::uint64_t kTurn_ns = 500'000;

/// Asks for turns of kTurn_ns for the calling thread, if it is SCHED_OTHER. From Linux 6.12 on, a thread that
/// wakes takes the processor from one with longer turns. Before that, and where the kernel refuses, nothing
/// changes. It is called with each sample; only the first call of a thread counts.
void ask_for_short_turns();

/// Schedules the calling thread, which carries samples, as given and with short turns. It is called with each
/// sample; only the first call of a thread counts.
void carry_samples(const Scheduling& as);

}  // namespace fathom::bus::detail

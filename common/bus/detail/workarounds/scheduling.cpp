#include "bus/detail/workarounds/scheduling.hpp"

#include <optional>

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace fathom::bus::detail {
namespace {

bool set(const Scheduling& to) {
  sched_param parameters{};
  parameters.sched_priority = to.priority;
  return sched_setscheduler(0, to.policy, &parameters) == 0;
}

Scheduling current() {
  sched_param parameters{};
  (void)sched_getparam(0, &parameters);
  return {sched_getscheduler(0), parameters.sched_priority};
}

std::optional<Scheduling> of_chores(const Scheduling& samples) {
  if (samples.policy == SCHED_OTHER) return Scheduling{SCHED_BATCH, 0};
  const bool real_time = samples.policy == SCHED_FIFO || samples.policy == SCHED_RR;
  if (real_time && samples.priority > 1) return Scheduling{samples.policy, samples.priority - 1};
  return std::nullopt;
}

/// As the kernel has it (sched_setattr(2)); older C libraries do not.
struct Attributes {
  std::uint32_t size = sizeof(Attributes);
  std::uint32_t policy = 0;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime_ns = 0;  ///< under SCHED_OTHER a turn
  std::uint64_t deadline_ns = 0;
  std::uint64_t period_ns = 0;
};

}  // namespace

ScopedChores::ScopedChores() : before_(current()) {
  const auto chores = of_chores(before_);
  changed_ = chores && set(*chores);
}

ScopedChores::~ScopedChores() {
  if (changed_) set(before_);
}

void carry_samples(const Scheduling& as) {
  thread_local bool done = false;
  if (done) return;
  done = true;
  set(as);
  ask_for_short_turns();
}

void ask_for_short_turns() {
  thread_local bool done = false;
  if (done) return;
  done = true;
  Attributes attributes;
  if (syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0) != 0) return;
  if (attributes.policy != SCHED_OTHER) return;
  attributes.runtime_ns = kTurn_ns;
  (void)syscall(SYS_sched_setattr, 0, &attributes, 0);
}

}  // namespace fathom::bus::detail

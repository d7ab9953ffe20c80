#include "bus/detail/scheduling.hpp"

#include <optional>

#include <sched.h>

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
}

}  // namespace fathom::bus::detail

#include "host/realtime.hpp"

#include <cerrno>
#include <system_error>

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace fathom::host {
namespace {

std::uint64_t soft_limit(__rlimit_resource_t resource) {
  rlimit limit{};
  return getrlimit(resource, &limit) == 0 ? limit.rlim_cur : 0;
}

int set_fifo(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return sched_setscheduler(0, SCHED_FIFO, &parameters) == 0 ? 0 : errno;
}

/// Tried with more than the limit allows: capabilities as /proc shows them may be those of a user namespace,
/// which do not count here.
bool may_lock_all() {
  const std::uint64_t limit = soft_limit(RLIMIT_MEMLOCK);
  if (limit == RLIM_INFINITY) return true;
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  const std::size_t size = (limit / page + 1) * page;
  void* const probe = mmap(nullptr, size, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (probe == MAP_FAILED) return false;
  const bool may = mlock2(probe, size, MLOCK_ONFAULT) == 0;
  munmap(probe, size);
  return may;
}

/// Code and data are brought in now. What is mapped later is locked page by page as it is touched: thread
/// stacks are 8 MB each, of which little is ever used.
int lock_all() {
  if (mlockall(MCL_CURRENT) != 0) return errno;
  return mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0 ? 0 : errno;
}

std::string reason(int error) {
  return std::generic_category().message(error);
}

std::string fifo_refused(int priority, int error, std::uint64_t limit) {
  const std::string wanted = std::to_string(priority);
  const std::string what = "no SCHED_FIFO " + wanted + ": ";
  if (error != EPERM) return what + reason(error);
  if (limit < static_cast<std::uint64_t>(priority)) {
    return what + "RLIMIT_RTPRIO is " + std::to_string(limit) + ", expected " + wanted +
           " (LimitRTPRIO=) or CAP_SYS_NICE";
  }
  return what + "forbidden, expected RestrictRealtime=no and sched_setscheduler allowed";
}

std::string lock_refused(std::uint64_t limit_bytes) {
  return "memory not locked: RLIMIT_MEMLOCK is " + std::to_string(limit_bytes / 1024) +
         " kB, expected infinity (LimitMEMLOCK=) or CAP_IPC_LOCK";
}

}  // namespace

RealtimeCalls kernel_calls() {
  return {set_fifo, [] { return soft_limit(RLIMIT_RTPRIO); }, may_lock_all,
          [] { return soft_limit(RLIMIT_MEMLOCK); }, lock_all};
}

std::vector<std::string> apply_realtime(const config::RealtimeConfig& config, const RealtimeCalls& calls) {
  std::vector<std::string> warnings;
  if (config.policy == config::SchedulingPolicy::fifo) {
    const int error = calls.set_fifo(config.priority);
    if (error != 0) warnings.push_back(fifo_refused(config.priority, error, calls.priority_limit()));
  }
  if (config.lock_memory) {
    if (!calls.may_lock_all()) {
      warnings.push_back(lock_refused(calls.lock_limit_bytes()));
    } else if (const int error = calls.lock_all(); error != 0) {
      warnings.push_back("memory not locked: " + reason(error));
    }
  }
  return warnings;
}

}  // namespace fathom::host

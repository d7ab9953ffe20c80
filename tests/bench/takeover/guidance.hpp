#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "bus/reader.hpp"
#include "samples/nav_state.hpp"
#include "samples/status/health.hpp"
#include "samples/status/replication.hpp"
#include "support/presence.hpp"
#include "support/process.hpp"

namespace fathom::test {

inline constexpr std::uint32_t kDomain = 94;
inline constexpr double kPatienceS = 120.0;
inline constexpr double kUnderWayDepth_m = 3.0;

struct Heard {
  NavState state;
  TimeNs arrived_ns = 0;
};

/// Guidance, and what the services say of themselves.
class Guidance {
 public:
  Guidance()
      : participant_(presence(kDomain, "takeover_bench")),
        states_(participant_,
                [this](const NavState& state, const bus::SampleInfo&) {
                  const std::lock_guard lock(mutex_);
                  heard_.push_back({state, clock_.monotonic_ns()});
                }),
        services_(participant_,
                  [this](const ServiceStatus& status, const bus::SampleInfo&) {
                    const std::lock_guard lock(mutex_);
                    pids_[status.header.sensor.str()] = static_cast<pid_t>(status.pid);
                  }),
        replicas_(participant_, [this](const ReplicaStatus& status, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex_);
          replicas_heard_[status.header.sensor.str()] = status;
        }) {}

  [[nodiscard]] std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return heard_.size();
  }
  [[nodiscard]] std::vector<Heard> since(std::size_t from) const {
    const std::lock_guard lock(mutex_);
    return {heard_.begin() + static_cast<std::ptrdiff_t>(from), heard_.end()};
  }
  [[nodiscard]] std::optional<NavState> newest() const {
    const std::lock_guard lock(mutex_);
    return heard_.empty() ? std::nullopt : std::optional(heard_.back().state);
  }
  [[nodiscard]] pid_t pid(const std::string& service) const {
    const std::lock_guard lock(mutex_);
    const auto found = pids_.find(service);
    return found == pids_.end() ? -1 : found->second;
  }
  /// Both are there and know the same; accounts from before `since_ns` (UTC) do not count.
  [[nodiscard]] bool both_in_step(TimeNs since_ns) const {
    const std::lock_guard lock(mutex_);
    int in_step = 0;
    for (const auto& [name, status] : replicas_heard_) {
      in_step += status.phase == ReplicaPhase::in_step && status.header.stamp_ns > since_ns ? 1 : 0;
    }
    return in_step == 2;
  }
  [[nodiscard]] std::uint64_t unprepared() const {
    const std::lock_guard lock(mutex_);
    std::uint64_t sum = 0;
    for (const auto& [name, status] : replicas_heard_) sum += status.unprepared;
    return sum;
  }

 private:
  SystemClock clock_;
  mutable std::mutex mutex_;
  std::vector<Heard> heard_;
  std::map<std::string, pid_t> pids_;
  std::map<std::string, ReplicaStatus> replicas_heard_;
  bus::Participant participant_;
  bus::Reader<NavState> states_;
  bus::Reader<ServiceStatus> services_;
  bus::Reader<ReplicaStatus> replicas_;
};

/// A vehicle navigates, in the soak test in the dive; one that has come to its end is begun again.
inline bool under_way(const Guidance& guidance, std::optional<Process>& demo, bool soak,
                      const std::vector<std::string>& options, const std::function<void()>& begins) {
  if (!demo || !demo->running()) {
    begins();
    std::vector<std::string> arguments{"--no-console", "--domain", std::to_string(kDomain), "--duration",
                                       "470"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    demo.emplace("fathom-demo", arguments);
  }
  const auto newest = guidance.newest();
  if (!newest || newest->alignment != AlignmentPhase::aligned) return false;
  // A fix is a step of its own: what is measured is measured in the dive.
  return !soak || (newest->depth_m > kUnderWayDepth_m && newest->mode > NavMode::gps_aided);
}

}  // namespace fathom::test

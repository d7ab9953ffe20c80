#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "config/fusion/fusion_config.hpp"
#include "fusion/checkpoint/checkpoint.hpp"
#include "fusion/replica/shared_state.hpp"
#include "host/service_host.hpp"
#include "samples/nav_state.hpp"

namespace fathom::fusion {

/// A fusion service among others on the vehicle network: hears which one leads, says how it is itself, gives
/// its state to those that lack it, and takes that of the leader when it lacks something.
///
/// All functions may be called from any thread. None of the hooks is called from within one of them, and no
/// lock is held while a hook runs.
class ReplicaLink {
 public:
  /// What came of a state.
  struct Restored {
    std::string text;      ///< of that, in words
    std::string error;     ///< why it was not taken; empty when it was
    bool unsound = false;  ///< because it is no state of such an engine
  };
  struct Hooks {
    /// False when there is nothing to give.
    std::function<bool(SharedState& state)> save;
    /// Takes up a state and what arrived since.
    std::function<Restored(const SharedState& state)> restore;
    /// Whether to keep what arrives, for restore.
    std::function<void(bool on)> keep_arrivals;
    std::function<void()> leads_now;
  };

  /// `label` as of a checkpoint, with the configuration's hash without what replicas differ in.
  ReplicaLink(host::ServiceHost& host, const config::FusionConfig& config, CheckpointLabel label,
              Hooks hooks);
  ~ReplicaLink();
  ReplicaLink(const ReplicaLink&) = delete;
  ReplicaLink& operator=(const ReplicaLink&) = delete;

  /// Speaks and listens from here on, and calls the hooks.
  void begin();

  /// The engine has a new state; whether to publish it.
  [[nodiscard]] bool own(const NavState& state);
  /// So many samples never arrived.
  void missed(std::uint64_t count);
  [[nodiscard]] bool leads() const;
  [[nodiscard]] bool in_step() const;

  /// For the life sign: phase in words, counters.
  void fill(ServiceStatus& status) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::fusion

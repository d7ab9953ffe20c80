#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "archive/checkpoint.hpp"
#include "base/result.hpp"
#include "config/fusion/fusion_config.hpp"
#include "fusion/replica/shared_state.hpp"
#include "host/service_host.hpp"
#include "samples/nav_state.hpp"

namespace fathom::fusion {

/// The link of one fusion service to the others on the vehicle network. It finds out which one leads,
/// publishes its own status, gives its state to services that lack it, and takes the leader's state when it
/// lacks something itself.
///
/// All functions may be called from any thread. They never call a hook themselves, and no lock is held while
/// a hook runs.
class ReplicaLink {
 public:
  /// The result of taking over a state.
  struct Restored {
    std::string text;      ///< the result in words
    std::string error;     ///< why it was not taken; empty when it was
    bool unsound = false;  ///< it is not a state of such an engine
  };
  struct Hooks {
    /// Fills a state to give away. False when there is none.
    std::function<bool(SharedState& state)> save;
    /// Takes over a state of the instance `from`, and what has arrived since it was saved.
    std::function<Restored(const SharedState& state, const Name& from)> restore;
    /// Whether to log what arrives, for restore.
    std::function<void(bool on)> keep_arrivals;
    /// Called when this service begins to lead.
    std::function<void()> leads_now;
  };

  /// `label` as of a checkpoint. Its hash of the configuration leaves out what replicas differ in.
  ReplicaLink(host::ServiceHost& host, const config::FusionConfig& config, archive::CheckpointLabel label,
              Hooks hooks);
  ~ReplicaLink();
  ReplicaLink(const ReplicaLink&) = delete;
  ReplicaLink& operator=(const ReplicaLink&) = delete;

  /// Starts the thread that publishes, listens and calls the hooks.
  void begin();
  /// Ends that thread. No hook runs any more, and none is called again.
  void end();

  /// Takes a new state of the engine. Returns whether to publish it.
  [[nodiscard]] bool own(const NavState& state);
  /// Counts samples that never arrived.
  void missed(std::uint64_t count);
  [[nodiscard]] bool leads() const;
  [[nodiscard]] bool in_step() const;

  /// Adds the phase in words and the counters to the life sign.
  void fill(ServiceStatus& status) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::fusion

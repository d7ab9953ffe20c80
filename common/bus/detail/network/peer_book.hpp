#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bus/detail/qos/qos_summary.hpp"
#include "bus/network_map.hpp"
#include "bus/participant.hpp"

namespace fathom::bus::detail {

using GuidPrefix = std::array<std::uint8_t, 12>;
[[nodiscard]] GuidPrefix prefix_of(const WriterGuid& guid);
[[nodiscard]] std::string hex(std::span<const std::uint8_t> guid);

/// A reader or writer of another participant.
struct RemoteEndpoint {
  std::string topic;
  std::string type;
  QosSummary qos;
};

/// The participants on the network with their readers and writers, from discovery. Thread-safe.
class PeerBook {
 public:
  void participant_seen(const GuidPrefix& prefix, const Peer& peer);
  /// Keeps the name for peer(), so that the samples of a dead service still have a name.
  void participant_gone(const GuidPrefix& prefix);
  void writer_seen(const WriterGuid& guid, const RemoteEndpoint& endpoint);
  void reader_seen(const WriterGuid& guid, const RemoteEndpoint& endpoint);
  void writer_gone(const WriterGuid& guid);
  void reader_gone(const WriterGuid& guid);

  [[nodiscard]] std::optional<Peer> peer(const WriterGuid& guid) const;
  [[nodiscard]] std::string name(const WriterGuid& guid) const;
  [[nodiscard]] std::vector<Peer> present() const;
  /// Names of the participants whose writers of this topic (readers, for a local writer) conflict with a
  /// local endpoint in `policy`.
  [[nodiscard]] std::set<std::string> writers_in_conflict(const std::string& topic, Policy policy,
                                                          const QosSummary& requested) const;
  [[nodiscard]] std::set<std::string> readers_in_conflict(const std::string& topic, Policy policy,
                                                          const QosSummary& offered) const;
  /// The longest deadline that a writer of this topic offers, of those up to `most_ns`; 0 without any.
  [[nodiscard]] DurationNs longest_deadline(const std::string& topic, DurationNs most_ns) const;
  /// Participants that use this topic with another type than `type`, each as "type 'x' of name".
  [[nodiscard]] std::vector<std::string> type_conflicts(const std::string& topic,
                                                        const std::string& type) const;
  /// Calls `visit(guid, endpoint)` for each writer of others, in the order of GUIDs; it must not call back.
  template <class Visit>
  void for_each_writer(Visit&& visit) const {
    const std::lock_guard lock(mutex_);
    for (const auto& [guid, one] : writers_) visit(guid, one);
  }
  /// The readers and writers of others, and the conflicts between any two of them.
  [[nodiscard]] std::vector<NetworkEndpoint> endpoints() const;
  [[nodiscard]] std::vector<NetworkConflict> conflicts() const;

 private:
  struct Known {
    Peer peer;
    bool present = true;
  };
  static constexpr std::size_t kRemembered = 256;  ///< participants that left

  [[nodiscard]] std::string name_locked(const WriterGuid& guid) const;
  [[nodiscard]] Peer peer_locked(const WriterGuid& guid) const;

  mutable std::mutex mutex_;
  std::map<GuidPrefix, Known> participants_;
  std::deque<GuidPrefix> left_;  ///< oldest first
  std::map<WriterGuid, RemoteEndpoint> writers_;
  std::map<WriterGuid, RemoteEndpoint> readers_;
};

}  // namespace fathom::bus::detail

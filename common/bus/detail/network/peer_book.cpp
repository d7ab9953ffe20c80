#include "bus/detail/network/peer_book.hpp"

#include <algorithm>
#include <array>
#include <tuple>

namespace fathom::bus::detail {
GuidPrefix prefix_of(const WriterGuid& guid) {
  GuidPrefix prefix;
  std::copy_n(guid.begin(), prefix.size(), prefix.begin());
  return prefix;
}

std::string hex(std::span<const std::uint8_t> guid) {
  constexpr const char* kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : guid) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

void PeerBook::participant_seen(const GuidPrefix& prefix, const Peer& peer) {
  const std::lock_guard lock(mutex_);
  participants_[prefix] = {peer, true};
}

void PeerBook::participant_gone(const GuidPrefix& prefix) {
  const std::lock_guard lock(mutex_);
  const auto found = participants_.find(prefix);
  if (found == participants_.end() || !found->second.present) return;
  found->second.present = false;
  left_.push_back(prefix);
  if (left_.size() > kRemembered) {
    const auto oldest = participants_.find(left_.front());
    if (oldest != participants_.end() && !oldest->second.present) participants_.erase(oldest);
    left_.pop_front();
  }
  const auto belongs = [&](const auto& entry) { return prefix_of(entry.first) == prefix; };
  std::erase_if(writers_, belongs);
  std::erase_if(readers_, belongs);
}

void PeerBook::writer_seen(const WriterGuid& guid, const RemoteEndpoint& endpoint) {
  const std::lock_guard lock(mutex_);
  writers_[guid] = endpoint;
}

void PeerBook::reader_seen(const WriterGuid& guid, const RemoteEndpoint& endpoint) {
  const std::lock_guard lock(mutex_);
  readers_[guid] = endpoint;
}

void PeerBook::writer_gone(const WriterGuid& guid) {
  const std::lock_guard lock(mutex_);
  writers_.erase(guid);
}

void PeerBook::reader_gone(const WriterGuid& guid) {
  const std::lock_guard lock(mutex_);
  readers_.erase(guid);
}

std::optional<Peer> PeerBook::peer(const WriterGuid& guid) const {
  const std::lock_guard lock(mutex_);
  const auto found = participants_.find(prefix_of(guid));
  if (found == participants_.end()) return std::nullopt;
  return found->second.peer;
}

std::string PeerBook::name_locked(const WriterGuid& guid) const {
  const auto found = participants_.find(prefix_of(guid));
  if (found == participants_.end() || found->second.peer.name.empty()) return hex(guid);
  return found->second.peer.name;
}

std::string PeerBook::name(const WriterGuid& guid) const {
  const std::lock_guard lock(mutex_);
  return name_locked(guid);
}

std::vector<Peer> PeerBook::present() const {
  const std::lock_guard lock(mutex_);
  std::vector<Peer> peers;
  for (const auto& [prefix, known] : participants_) {
    if (known.present) peers.push_back(known.peer);
  }
  return peers;
}

std::set<std::string> PeerBook::writers_in_conflict(const std::string& topic, Policy policy,
                                                    const QosSummary& requested) const {
  const std::lock_guard lock(mutex_);
  std::set<std::string> names;
  for (const auto& [guid, writer] : writers_) {
    if (writer.topic == topic && conflict(policy, writer.qos, requested)) names.insert(name_locked(guid));
  }
  return names;
}

std::set<std::string> PeerBook::readers_in_conflict(const std::string& topic, Policy policy,
                                                    const QosSummary& offered) const {
  const std::lock_guard lock(mutex_);
  std::set<std::string> names;
  for (const auto& [guid, reader] : readers_) {
    if (reader.topic == topic && conflict(policy, offered, reader.qos)) names.insert(name_locked(guid));
  }
  return names;
}

DurationNs PeerBook::longest_deadline(const std::string& topic, DurationNs most_ns) const {
  const std::lock_guard lock(mutex_);
  DurationNs longest = 0;
  for (const auto& [guid, writer] : writers_) {
    if (writer.topic == topic && writer.qos.deadline_ns <= most_ns)
      longest = std::max(longest, writer.qos.deadline_ns);
  }
  return longest;
}

std::vector<std::string> PeerBook::type_conflicts(const std::string& topic, const std::string& type) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> conflicts;
  for (const auto* endpoints : {&writers_, &readers_}) {
    for (const auto& [guid, endpoint] : *endpoints) {
      if (endpoint.topic == topic && endpoint.type != type) {
        conflicts.push_back("type '" + endpoint.type + "' of " + name_locked(guid));
      }
    }
  }
  return conflicts;
}

Peer PeerBook::peer_locked(const WriterGuid& guid) const {
  const auto found = participants_.find(prefix_of(guid));
  Peer peer = found == participants_.end() ? Peer{} : found->second.peer;
  if (peer.name.empty()) peer.name = hex(guid);
  return peer;
}

std::vector<NetworkEndpoint> PeerBook::endpoints() const {
  const std::lock_guard lock(mutex_);
  std::vector<NetworkEndpoint> out;
  for (const auto& [guid, one] : writers_) out.push_back({peer_locked(guid), one.topic, one.type, true});
  for (const auto& [guid, one] : readers_) out.push_back({peer_locked(guid), one.topic, one.type, false});
  std::sort(out.begin(), out.end(), [](const NetworkEndpoint& a, const NetworkEndpoint& b) {
    return std::tie(a.topic, b.writes, a.owner.name) < std::tie(b.topic, a.writes, b.owner.name);
  });
  return out;
}

std::vector<NetworkConflict> PeerBook::conflicts() const {
  constexpr std::array kPolicies{Policy::reliability, Policy::durability, Policy::deadline, Policy::ownership,
                                 Policy::liveliness};
  const std::lock_guard lock(mutex_);
  std::vector<NetworkConflict> out;
  for (const auto& [writer_guid, writer] : writers_) {
    for (const auto& [reader_guid, reader] : readers_) {
      if (reader.topic != writer.topic) continue;
      const Peer from = peer_locked(writer_guid);
      const Peer to = peer_locked(reader_guid);
      if (reader.type != writer.type) {
        out.push_back({writer.topic, "type", from, writer.type, to, reader.type});
        continue;
      }
      for (const Policy policy : kPolicies) {
        if (!conflict(policy, writer.qos, reader.qos)) continue;
        out.push_back({writer.topic, to_string(policy), from, value_text(policy, writer.qos), to,
                       value_text(policy, reader.qos)});
      }
    }
  }
  return out;
}

}  // namespace fathom::bus::detail

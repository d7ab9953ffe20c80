#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"
#include "base/writer_guid.hpp"

namespace fathom::bus {

/// Creating an entity failed; the message names the entity, its topic and the remedy where one is known.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The credentials of a protected network cannot be used; the message names the file, what is wrong with it
/// and what was expected.
class CredentialsError : public BusError {
 public:
  using BusError::BusError;
};

/// How a participant proves who it is on a protected network (DDS Security).
struct SecurityOptions {
  std::string folder;    ///< credentials as `fathom keygen` makes; empty: the network is not protected
  std::string identity;  ///< whose credentials in the folder; empty: those of the participant's name
};

struct ParticipantOptions {
  std::string name;  ///< service name, seen by others in discovery; at most 255 bytes
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses bound, nothing else is
  std::vector<std::string> peers{"127.0.0.1"};       ///< asked for discovery besides multicast
  /// Folder of the QoS XML; every *.xml in it is loaded. Empty: the environment's FATHOM_DDS_DIR, else
  /// deploy/dds or share/fathom/dds above the executable.
  std::string profiles_dir;
  SecurityOptions security{};
  /// The participant only watches, e.g. for display, and nobody waits for its results. Writers send to it
  /// after all others, and its receiving threads give way to other services when the processor is busy.
  bool low_priority = false;
  /// "address:port" of discovery servers. When there are any, other participants are found through them
  /// alone, without multicast, and `peers` is not used. Only participants with a topic in common get to know
  /// each other. A participant that falls silent looks like one that leaves, so that its writers raise no
  /// BusEventKind::writer_lost.
  std::vector<std::string> discovery_servers{};
  bool discover_everything = false;  ///< a client of servers gets to know everybody and all topics
  /// "address:port" at which this participant is a discovery server; the address is one of `interfaces`.
  /// Empty: it is no server. Creating a server takes as long as a participant's lease, so that clients have
  /// given up a server that was killed before.
  std::string discovery_listen{};
  /// What it adds to its USER_DATA in discovery, for those of another house: "key=value;".
  std::string user_data{};
};

enum class BusEventKind : std::uint8_t {
  incompatible_qos,  ///< a reader and a writer of this topic cannot meet; detail names the policy
  deadline_missed,
  writer_lost,
  sample_lost,
  write_failed,
  resource_limit,      ///< a reader had no room for a sample
  invalid_sample,      ///< bytes arrived that are no sample of the topic's type
  stranger_refused,    ///< somebody has not proved an identity of this vehicle; no topic
  permission_refused,  ///< somebody tried to read or write a topic without permission
  malformed_datagram,  ///< one that would have ended or blocked this process; no topic
};

/// The kind in words, e.g. "deadline missed".
[[nodiscard]] std::string_view to_string(BusEventKind kind);

/// A fault on the network. Every occurrence is counted. For each kind, topic and peer the first occurrence is
/// reported, and the first one after a time without faults.
struct BusEvent {
  BusEventKind kind = BusEventKind::incompatible_qos;
  std::string topic;
  std::string detail;  ///< one English line: who, what, and the limit or policy
};

/// Counts since start, for ServiceStatus.
struct BusCounters {
  std::uint64_t incompatible_qos = 0;
  std::uint64_t deadline_missed = 0;
  std::uint64_t writer_lost = 0;
  std::uint64_t sample_lost = 0;
  std::uint64_t write_failed = 0;
  std::uint64_t resource_limit = 0;
  std::uint64_t invalid_sample = 0;
  std::uint64_t stranger_refused = 0;
  std::uint64_t permission_refused = 0;
  std::uint64_t malformed_datagram = 0;
};

/// Another participant, as discovery describes it.
struct Peer {
  std::string name;  ///< ParticipantOptions::name for services of this project
  std::string host;  ///< empty when the participant does not say
  std::uint32_t pid = 0;
  bool offers_identity = false;  ///< it expects other participants to prove their identities
  bool low_priority = false;     ///< as in its ParticipantOptions
};

/// A participant on a protected network that has not proved an identity of this vehicle. Its name and address
/// are its own claims.
struct Stranger {
  std::string name;
  std::string guid;     ///< of the participant, hexadecimal
  std::string address;  ///< empty when it does not say
  std::string why;      ///< what it did not do, e.g. "offers no identity"
};
/// One line for people, safe to print whatever the stranger calls itself.
[[nodiscard]] std::string to_string(const Stranger& stranger);

/// Presence of a service on the vehicle network. Must outlive its readers and writers.
class Participant {
 public:
  /// Throws BusError, and CredentialsError before anything is sent.
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// On a protected network the caller has to call this now and then, because it also decides who has
  /// announced itself and never proved an identity.
  [[nodiscard]] BusCounters counters() const;
  /// `handler` is called for each reported event, one at a time, from threads of the bus. It must be quick,
  /// and must not create or destroy readers and writers. Events reported before it was set are delivered at
  /// once. When on_event() returns, the previous handler is no longer running. Without a handler events are
  /// kept.
  void on_event(std::function<void(const BusEvent&)> handler);

  /// The participant that a writer belongs to. It stays known for a while after it left.
  [[nodiscard]] std::optional<Peer> peer(const WriterGuid& writer) const;
  /// The name of that participant, or the GUID in hexadecimal where discovery gave no name.
  [[nodiscard]] std::string writer_name(const WriterGuid& writer) const;
  /// Everybody present on the domain, without this participant.
  [[nodiscard]] std::vector<Peer> peers() const;
  /// Everybody present whom this participant does not speak to. peers() does not list them. Empty on a
  /// network that is not protected.
  [[nodiscard]] std::vector<Stranger> strangers() const;
  /// The end of the credentials' validity, UTC; nothing on a network that is not protected.
  [[nodiscard]] std::optional<TimeNs> credentials_until_ns() const;
  /// The longest silence after which others still know this participant. A process that stalled for longer
  /// has to make its participant again on a protected network. Nothing on a network that is not protected.
  [[nodiscard]] std::optional<DurationNs> longest_silence_ns() const;
  /// "identity fusion expires in 12 days (2026-03-01)" when the expiry is near or past at `now`, else empty.
  [[nodiscard]] std::string credentials_warning(TimeNs now) const;

  struct Impl;
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus

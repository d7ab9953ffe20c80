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
  /// It looks on and nobody waits for what it makes of the samples: it is sent them after all others, and
  /// receiving them gives way to the services that do more, on a processor that has not enough for all at
  /// once.
  bool low_priority = false;
  /// "address:port" of discovery servers. Not empty: others are found through them alone, without multicast,
  /// and `peers` is not used. Only participants with a topic in common get to know each other, and one that
  /// falls silent is not told from one that leaves: its writers are no BusEventKind::writer_lost.
  std::vector<std::string> discovery_servers{};
  bool discover_everything = false;  ///< as a client of servers: everybody and all of their topics
  /// "address:port" at which this participant is a discovery server to others; the address is one of
  /// `interfaces`. Empty: it is none. A server is created after the lease of a participant has passed, so
  /// that clients have given up one that was killed before it.
  std::string discovery_listen{};
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

/// Something went wrong on the network. Every occurrence is counted; the first of each kind × topic × peer is
/// reported, and the first after things were well again in between.
struct BusEvent {
  BusEventKind kind = BusEventKind::incompatible_qos;
  std::string topic;
  std::string detail;  ///< one English line: who, what, and the limit or policy concerned
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

/// Another participant, as discovery knows it.
struct Peer {
  std::string name;  ///< ParticipantOptions::name for services of this project
  std::string host;  ///< empty when the participant does not say
  std::uint32_t pid = 0;
  bool offers_identity = false;  ///< it expects others to prove theirs
  bool low_priority = false;     ///< as its ParticipantOptions have it
};

/// Somebody on a protected network who has not proved an identity of this vehicle. Name and address are
/// hearsay.
struct Stranger {
  std::string name;
  std::string guid;     ///< of the participant, hexadecimal
  std::string address;  ///< empty when it does not say
  std::string why;      ///< what it did not do, e.g. "offers no identity"
};
/// One line for people, cleaned of what strangers may put into their names.
[[nodiscard]] std::string to_string(const Stranger& stranger);

/// Presence of a service on the vehicle network. Must outlive its readers and writers.
class Participant {
 public:
  /// Throws BusError, and CredentialsError before anything is sent.
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// On a protected network to be called now and then: it is also when those are judged who announce
  /// themselves and never prove an identity.
  [[nodiscard]] BusCounters counters() const;
  /// `handler` is called for each reported event, one at a time, from threads of the bus: be quick, and do
  /// not create or destroy readers and writers in it. What was reported before it was set is delivered at
  /// once. When on_event() returns, the previous handler is no longer running. Default: nobody.
  void on_event(std::function<void(const BusEvent&)> handler);

  /// The participant that a writer belongs to, also for a while after it left; nothing if never seen.
  [[nodiscard]] std::optional<Peer> peer(const WriterGuid& writer) const;
  /// Its name; the GUID in hexadecimal where discovery gave none.
  [[nodiscard]] std::string writer_name(const WriterGuid& writer) const;
  /// Everybody present on the domain, without this participant.
  [[nodiscard]] std::vector<Peer> peers() const;
  /// Everybody present whom this participant does not speak to; peers() has only the others. Empty on a
  /// network that is not protected.
  [[nodiscard]] std::vector<Stranger> strangers() const;
  /// Until when the credentials hold, UTC; nothing on a network that is not protected.
  [[nodiscard]] std::optional<TimeNs> credentials_until_ns() const;
  /// A participant that has been silent this long, because its process stalled, has been given up by the
  /// others, and on a protected network for good: it has to be made anew. Nothing on a network that is not
  /// protected.
  [[nodiscard]] std::optional<DurationNs> longest_silence_ns() const;
  /// "identity fusion expires in 12 days (2026-03-01)" when that is near or past at `now`; else empty.
  [[nodiscard]] std::string credentials_warning(TimeNs now) const;

  struct Impl;
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus

#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::bus {

/// Creating an entity failed; the message names the entity, its topic and the remedy where one is known.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ParticipantOptions {
  std::string name;  ///< service name, seen by others in discovery; at most 255 bytes
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses bound, nothing else is
  std::vector<std::string> peers{"127.0.0.1"};       ///< asked for discovery besides multicast
  /// Folder of the QoS XML; every *.xml in it is loaded. Empty: the environment's FATHOM_DDS_DIR, else
  /// deploy/dds or share/fathom/dds above the executable.
  std::string profiles_dir;
};

enum class BusEventKind : std::uint8_t {
  incompatible_qos,  ///< a reader and a writer of this topic cannot meet; detail names the policy
  deadline_missed,
  writer_lost,
  sample_lost,
  write_failed,
  resource_limit,  ///< a reader had no room for a sample
  invalid_sample,  ///< bytes arrived that are no sample of the topic's type
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
};

/// Identity of a writer, unique on the network; SampleInfo carries it.
using WriterGuid = std::array<std::uint8_t, 16>;

/// Another participant, as discovery knows it.
struct Peer {
  std::string name;  ///< ParticipantOptions::name for services of this project
  std::string host;  ///< empty when the participant does not say
  std::uint32_t pid = 0;
};

/// Presence of a service on the vehicle network. Must outlive its readers and writers.
class Participant {
 public:
  /// Throws BusError.
  explicit Participant(const ParticipantOptions& options);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

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

  struct Impl;
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus

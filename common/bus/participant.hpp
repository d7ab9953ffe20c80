#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace fathom::bus {

/// Creating an entity failed; the message names the entity, its topic and the remedy where one is known.
class BusError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ParticipantOptions {
  std::string name;  ///< service name, seen by others in discovery
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses bound, nothing else is
  std::vector<std::string> peers{"127.0.0.1"};       ///< asked for discovery besides multicast
  std::string profiles_dir;                          ///< folder of the QoS XML; every *.xml in it is loaded
};

enum class BusEventKind : std::uint8_t {
  incompatible_qos,  ///< a reader and a writer of this topic cannot meet; detail names the policy
  deadline_missed,
  writer_lost,
  sample_lost,
  write_failed,
  resource_limit,
};

/// Something went wrong on the network. Each kind × topic × peer is logged once and counted.
struct BusEvent {
  BusEventKind kind = BusEventKind::incompatible_qos;
  std::string topic;
  std::string detail;
};

/// Counts since start, for ServiceStatus.
struct BusCounters {
  std::uint64_t incompatible_qos = 0;
  std::uint64_t deadline_missed = 0;
  std::uint64_t writer_lost = 0;
  std::uint64_t sample_lost = 0;
  std::uint64_t write_failed = 0;
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
  /// Called once per new kind × topic × peer, from a thread of the bus: be quick. Default: nobody.
  void on_event(std::function<void(const BusEvent&)> handler);

  struct Impl;
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::bus

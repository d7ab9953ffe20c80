#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/unknown.hpp"
#include "bus/interfaces.hpp"
#include "bus/network_map.hpp"
#include "health/writers/service_voices.hpp"
#include "samples/status/health.hpp"

namespace fathom::cli {

/// A file that Fast DDS left in shared memory and no process uses any more.
struct ShmLeftover {
  std::string path;
  std::uint64_t bytes = 0;
};

/// What this host offers to services. Unknown where it could not be found out.
struct HostFacts {
  std::string name;
  std::vector<bus::LocalAddress> addresses;
  std::optional<bool> clock_disciplined;  ///< by NTP, PTP or a GPS receiver, as the kernel knows
  double clock_error_s = kUnknown;        ///< at most, as the kernel knows
  std::optional<std::uint64_t> shm_free_bytes;
  std::vector<ShmLeftover> shm_leftovers;
  std::optional<std::uint64_t> open_files;            ///< limit of a process
  std::optional<std::uint64_t> receive_buffer_bytes;  ///< largest of a socket
  std::optional<int> realtime_priority;               ///< highest that may be asked for
};

/// A service's life sign, and how far its host's clock is behind this host's (negative: ahead), the way
/// included.
struct HeardService {
  ServiceStatus status;
  health::ServiceVoices voices{};  ///< the processes that speak as this service
  double behind_s = kUnknown;
};

/// What was found on the domain.
struct NetworkFacts {
  std::uint32_t domain = 0;
  std::vector<std::string> interfaces;  ///< asked for
  bool is_protected = false;            ///< looked at with an identity
  std::vector<bus::Peer> participants;
  std::vector<bus::Stranger> strangers;  ///< whom nobody speaks to
  std::vector<bus::NetworkEndpoint> endpoints;
  std::vector<bus::NetworkConflict> conflicts;
  std::vector<HeardService> services;
};

enum class FindingLevel : std::uint8_t { good, notice, problem };
[[nodiscard]] std::string_view to_string(FindingLevel level);

struct Finding {
  FindingLevel level = FindingLevel::good;
  std::string subject;  ///< "network", "security", "qos", "topics", "writers", "services", "clock", "memory"
                        ///< or "limits"
  std::string text;     ///< what was found, one sentence
  std::string remedy;   ///< what to do about it; empty where nothing is to be done
};

/// Judges all of it. Pure. Each subject has at least one finding.
[[nodiscard]] std::vector<Finding> examine(const NetworkFacts& network, const HostFacts& host);

}  // namespace fathom::cli

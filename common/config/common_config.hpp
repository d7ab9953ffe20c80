#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fathom::config {

/// Section "bus.security": whether and as whom this service takes part in a protected network.
struct BusSecurityConfig {
  std::string folder;    ///< credentials as `fathom keygen` makes; empty: the network is not protected
  std::string identity;  ///< whose credentials in the folder; empty: those of the service's name
};

/// Section "bus": where on the vehicle network this service is present.
struct BusConfig {
  int domain = 0;
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses bound, nothing else is
  std::vector<std::string> peers{"127.0.0.1"};       ///< asked for discovery besides multicast
  std::string profiles_dir;  ///< folder of the QoS XML; empty: found beside the executable or where installed
  BusSecurityConfig security;
  /// "address:port" of discovery servers; not empty: others are found through them alone, peers are not used
  std::vector<std::string> discovery_servers;
};

/// Section "log".
struct LogConfig {
  std::string level = "info";  ///< trace, debug, info, warning, error
};

/// Section "clock": what the service calls now.
struct ClockConfig {
  double rate = 1.0;          ///< vehicle seconds per host second
  std::int64_t epoch_ns = 0;  ///< UTC instant at which an accelerated clock starts; 0: the host's own clock
  std::string anchor_file;    ///< see runtime::ClockAnchor; empty: UTC as it is when the service starts
};

enum class SchedulingPolicy : std::uint8_t {
  other = 0,  ///< as the service was started
  fifo = 1,   ///< SCHED_FIFO for every thread of the service
};

/// Section "realtime": what the service asks of the kernel before it starts its threads.
struct RealtimeConfig {
  SchedulingPolicy policy = SchedulingPolicy::other;
  int priority = 20;         ///< of SCHED_FIFO, 1 (lowest) to 99
  bool lock_memory = false;  ///< what is in memory stays there
};

/// The part that the file of every service has. A service's own configuration struct holds one as the member
/// `common`; its sections stand at the top level of the file.
struct CommonConfig {
  std::string vehicle = "auv";
  BusConfig bus;
  LogConfig log;
  ClockConfig clock;
  RealtimeConfig realtime;
};

}  // namespace fathom::config

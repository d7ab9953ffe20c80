#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fathom::config {

/// Section "bus": where on the vehicle network this service is present.
struct BusConfig {
  int domain = 0;
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses bound, nothing else is
  std::vector<std::string> peers{"127.0.0.1"};       ///< asked for discovery besides multicast
  std::string profiles_dir;  ///< folder of the QoS XML; empty: found beside the executable or where installed
};

/// Section "log".
struct LogConfig {
  std::string level = "info";  ///< trace, debug, info, warning, error
};

/// Section "clock": what the service calls now.
struct ClockConfig {
  double rate = 1.0;          ///< vehicle seconds per host second
  std::int64_t epoch_ns = 0;  ///< UTC instant at which an accelerated clock starts; 0: the host's own clock
};

/// The part that the file of every service has. A service's own configuration struct holds one as the member
/// `common`; its sections stand at the top level of the file.
struct CommonConfig {
  std::string vehicle = "auv";
  BusConfig bus;
  LogConfig log;
  ClockConfig clock;
};

}  // namespace fathom::config

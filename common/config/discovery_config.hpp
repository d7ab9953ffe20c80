#pragma once

#include <string>

#include "config/common_config.hpp"
#include "config/registry.hpp"

namespace fathom::config {

/// deploy/config/discovery.json
struct DiscoveryConfig {
  CommonConfig common;
  std::string discovery_listen = "127.0.0.1:11811";  ///< address, one of bus.interfaces, and UDP port
};

[[nodiscard]] ConfigKind discovery_kind();

}  // namespace fathom::config

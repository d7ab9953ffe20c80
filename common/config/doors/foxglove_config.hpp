#pragma once

#include <string>

#include "config/common_config.hpp"
#include "config/registry.hpp"

namespace fathom::config {

/// Section "access": who may look.
struct FoxgloveAccessConfig {
  bool view_needs_token = false;  ///< else everyone who reaches the port
  std::string token_file;         ///< as the console's
};

/// Section "tls": both files, or none for ws in clear.
struct FoxgloveTlsConfig {
  std::string certificate_file;  ///< PEM, with its chain
  std::string key_file;          ///< PEM, without a passphrase
};

/// deploy/config/foxglove.json
struct FoxgloveConfig {
  CommonConfig common;
  std::string address = "127.0.0.1";
  int port = 8765;
  int most_clients = 16;
  double queue_mb = 4.0;  ///< of each client
  FoxgloveAccessConfig access;
  FoxgloveTlsConfig tls;
};

[[nodiscard]] ConfigKind foxglove_kind();

}  // namespace fathom::config

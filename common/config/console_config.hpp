#pragma once

#include <string>
#include <vector>

#include "base/unknown.hpp"
#include "config/common_config.hpp"
#include "config/registry.hpp"

namespace fathom::config {

/// Where the console is found on DDS domain 0; on another one as much further.
inline constexpr int kFirstConsolePort = 8420;

/// Section "http": where browsers find the console.
struct ConsoleHttpConfig {
  std::string address = "127.0.0.1";  ///< listened at; an IPv4 address of this host, or 0.0.0.0 for all
  int port = 0;                       ///< 0: 8420 plus the DDS domain
  std::vector<std::string> names;     ///< by which browsers call this host besides its address
  int most_connections = 128;
  int most_connections_per_peer = 96;
  int most_streams = 48;
  int most_streams_per_viewer = 12;  ///< of one token; without one: of one address
};

/// Section "tls": both files, or none for http in clear.
struct ConsoleTlsConfig {
  std::string certificate_file;  ///< PEM, with its chain
  std::string key_file;          ///< PEM, without a passphrase
};

/// Section "access": who may see and who may give orders.
struct ConsoleAccessConfig {
  bool orders = false;            ///< orders from the page are taken at all
  bool view_needs_token = false;  ///< else everyone who reaches the port may look
  std::string token_file;         ///< who holds which token; empty: nobody has one
};

struct ConsoleWaypoint {
  std::string name;
  double latitude_deg = kUnknown;
  double longitude_deg = kUnknown;
};

/// Section "map".
struct ConsoleMapConfig {
  std::string tiles_dir;  ///< folder of z/x/y.png; empty: a metric grid
  std::vector<ConsoleWaypoint> waypoints;
};

/// deploy/config/console.json
struct ConsoleConfig {
  CommonConfig common;
  ConsoleHttpConfig http;
  ConsoleTlsConfig tls;
  ConsoleAccessConfig access;
  ConsoleMapConfig map;
  double updates_hz = 10.0;  ///< to each browser
  double fresh_s = 0.7;      ///< an older navigation state is none

  [[nodiscard]] int port() const {
    return http.port != 0 ? http.port : kFirstConsolePort + common.bus.domain;
  }
};

[[nodiscard]] ConfigKind console_kind();

}  // namespace fathom::config

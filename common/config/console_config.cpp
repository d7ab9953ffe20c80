#include "config/console_config.hpp"

#include <string>
#include <utility>

#include <arpa/inet.h>

#include "config/service_schema.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

}  // namespace

void describe(Schema<ConsoleHttpConfig>& s) {
  s.field("address", &ConsoleHttpConfig::address,
          "IPv4 address that is listened at: this host's own, 0.0.0.0 for every one it has");
  s.field("port", &ConsoleHttpConfig::port, "TCP port; 0: 8420 plus the DDS domain").range(0, 65535);
  s.field("names", &ConsoleHttpConfig::names,
          "by which browsers call this host besides its address; any other Host is refused");
  s.field("most_connections", &ConsoleHttpConfig::most_connections, "at the same time").range(4, 1000);
  s.field("most_connections_per_peer", &ConsoleHttpConfig::most_connections_per_peer,
          "at the same time from one address")
      .range(2, 1000);
  s.field("most_streams", &ConsoleHttpConfig::most_streams, "open pages at the same time").range(1, 500);
  s.field("most_streams_per_viewer", &ConsoleHttpConfig::most_streams_per_viewer,
          "open pages at the same time of one token, or of one address that shows none")
      .range(1, 500);
  s.check([](const ConsoleHttpConfig& http) -> Fault {
    in_addr parsed{};
    if (inet_pton(AF_INET, http.address.c_str(), &parsed) != 1) {
      return {"address", "an IPv4 address such as 127.0.0.1"};
    }
    if (http.most_streams >= http.most_connections) return {"most_streams", "less than most_connections"};
    return {};
  });
}

void describe(Schema<ConsoleTlsConfig>& s) {
  s.field("certificate_file", &ConsoleTlsConfig::certificate_file,
          "PEM file with the certificate and its chain; empty: http in clear");
  s.field("key_file", &ConsoleTlsConfig::key_file,
          "PEM file with the certificate's private key, mode 0600 or 0640, without a passphrase");
  s.check([](const ConsoleTlsConfig& tls) -> Fault {
    if (!tls.certificate_file.empty() && tls.key_file.empty()) {
      return {"key_file", "a file, because certificate_file names one"};
    }
    if (tls.certificate_file.empty() && !tls.key_file.empty()) {
      return {"certificate_file", "a file, because key_file names one"};
    }
    return {};
  });
}

void describe(Schema<ConsoleAccessConfig>& s) {
  s.field("orders", &ConsoleAccessConfig::orders, "operators may give orders from the page");
  s.field("view_needs_token", &ConsoleAccessConfig::view_needs_token,
          "the page shows data only to those with a token");
  s.field("token_file", &ConsoleAccessConfig::token_file,
          "JSON file with the tokens of viewers and operators, mode 0600; empty: none");
  s.check([](const ConsoleAccessConfig& access) -> Fault {
    const bool wanted = access.orders || access.view_needs_token;
    if (wanted && access.token_file.empty()) {
      return {"token_file", "a file, because orders or view_needs_token are on"};
    }
    return {};
  });
}

void describe(Schema<ConsoleWaypoint>& s) {
  s.field("name", &ConsoleWaypoint::name, "shown beside it").required();
  s.field("lat_deg", &ConsoleWaypoint::latitude_deg, "latitude").unit("deg").range(-90, 90).required();
  s.field("lon_deg", &ConsoleWaypoint::longitude_deg, "longitude").unit("deg").range(-180, 180).required();
}

void describe(Schema<ConsoleMapConfig>& s) {
  s.field("tiles_dir", &ConsoleMapConfig::tiles_dir,
          "folder of map tiles z/x/y.png; empty: the map shows a metric grid");
  s.field("waypoints", &ConsoleMapConfig::waypoints, "drawn on the map");
}

void describe(Schema<ConsoleConfig>& s) {
  s.include(&ConsoleConfig::common);
  s.field("http", &ConsoleConfig::http, "where browsers find the console");
  s.field("tls", &ConsoleConfig::tls, "https instead of http");
  s.field("access", &ConsoleConfig::access, "who may see and who may give orders");
  s.field("map", &ConsoleConfig::map, "the map");
  s.field("updates_hz", &ConsoleConfig::updates_hz,
          "how often each browser is told, however fast sensors are")
      .unit("Hz")
      .range(1, 20);
  s.field("fresh_s", &ConsoleConfig::fresh_s, "a navigation state older than this is none")
      .unit("s")
      .range(0.2, 5);
}

template LoadedConfig<ConsoleConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<ConsoleConfig>();

ConfigKind console_kind() {
  return make_kind<ConsoleConfig>("console");
}

}  // namespace fathom::config

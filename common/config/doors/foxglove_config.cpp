#include "config/doors/foxglove_config.hpp"

#include <utility>

#include "config/service_schema.hpp"
#include "runtime/byte_source.hpp"

namespace fathom::config {
namespace {

using Fault = std::pair<std::string, std::string>;

}  // namespace

void describe(Schema<FoxgloveAccessConfig>& s) {
  s.field("view_needs_token", &FoxgloveAccessConfig::view_needs_token,
          "only who shows a token may look: ws://host:port/?token=...");
  s.field("token_file", &FoxgloveAccessConfig::token_file, "who holds which token, as for the console");
}

void describe(Schema<FoxgloveTlsConfig>& s) {
  s.field("certificate_file", &FoxgloveTlsConfig::certificate_file,
          "PEM, with its chain; empty: ws in clear");
  s.field("key_file", &FoxgloveTlsConfig::key_file, "PEM, without a passphrase");
}

void describe(Schema<FoxgloveConfig>& s) {
  using C = FoxgloveConfig;
  s.include(&C::common);
  s.field("address", &C::address, "numeric address of this host that is listened at");
  s.field("port", &C::port, "TCP port").range(1, 65'535);
  s.field("most_clients", &C::most_clients, "at a time").range(1, 256);
  s.field("queue_mb", &C::queue_mb, "messages that wait for a slow client; the oldest are left out then")
      .unit("MB")
      .range(0.1, 256);
  s.field("access", &C::access, "who may look");
  s.field("tls", &C::tls, "wss instead of ws");
  s.check([](const C& c) -> Fault {
    if (!runtime::is_numeric_address(c.address)) return {"address", "a numeric IPv4 or IPv6 address"};
    if (c.access.view_needs_token && c.access.token_file.empty())
      return {"access.token_file", "a file, because access.view_needs_token is on"};
    if (c.tls.certificate_file.empty() != c.tls.key_file.empty())
      return {"tls", "certificate_file and key_file, or neither"};
    return {};
  });
}

template LoadedConfig<FoxgloveConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<FoxgloveConfig>();

ConfigKind foxglove_kind() {
  return make_kind<FoxgloveConfig>("foxglove");
}

}  // namespace fathom::config

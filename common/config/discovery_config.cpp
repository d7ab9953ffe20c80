#include "config/discovery_config.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "config/service_schema.hpp"

namespace fathom::config {

void describe(Schema<DiscoveryConfig>& s) {
  s.include(&DiscoveryConfig::common);
  s.field("discovery_listen", &DiscoveryConfig::discovery_listen,
          "address, one of bus.interfaces, and UDP port at which the others look for this server");
  s.check([](const DiscoveryConfig& config) -> std::pair<std::string, std::string> {
    if (!is_address_and_port(config.discovery_listen)) return {"discovery_listen", kAddressAndPort};
    const std::string address = config.discovery_listen.substr(0, config.discovery_listen.find(':'));
    const auto& interfaces = config.common.bus.interfaces;
    if (std::find(interfaces.begin(), interfaces.end(), address) == interfaces.end()) {
      return {"discovery_listen", "an address of bus.interfaces"};
    }
    return {};
  });
}

template LoadedConfig<DiscoveryConfig> load_service_config(const LoadRequest& request);
template std::string explain_service_config<DiscoveryConfig>();

ConfigKind discovery_kind() {
  return make_kind<DiscoveryConfig>("discovery");
}

}  // namespace fathom::config

#include "config/doors/mavlink_gateway_config.hpp"
#include "host/run.hpp"
#include "mavlink_gateway/mavlink_gateway_service.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::MavlinkGatewayConfig>(
      argc, argv,
      {"mavlink_gateway", "Tells an autopilot the navigation state by MAVLink, as external navigation.",
       true},
      [](host::ServiceHost& host, const config::MavlinkGatewayConfig& config) {
        mavlink_gateway::MavlinkGatewayService service(host, config);
        return host.run();
      },
      [](const config::MavlinkGatewayConfig& config, const std::string& file, bool /*check*/) {
        (void)mavlink_gateway::key_in(config.signing, file);
      });
}

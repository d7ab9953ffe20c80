#include "config/discovery_config.hpp"
#include "host/run.hpp"

// The work is the participant's own, as host::run() is told by the configuration's discovery_listen.
int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::DiscoveryConfig>(
      argc, argv, {"discovery", "Tells services of several machines about each other, without multicast."},
      [](host::ServiceHost& host, const config::DiscoveryConfig& config) {
        host.log().info("serves discovery at " + config.discovery_listen);
        return host.run();
      });
}

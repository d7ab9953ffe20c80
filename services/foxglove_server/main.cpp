#include "config/doors/foxglove_config.hpp"
#include "foxglove_server/foxglove_service.hpp"
#include "host/run.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::FoxgloveConfig>(
      argc, argv,
      {"foxglove", "Shows what is said on the vehicle network to clients of the Foxglove protocol.", true},
      [](host::ServiceHost& host, const config::FoxgloveConfig& config) {
        foxglove::FoxgloveService service(host, config);
        return host.run();
      },
      foxglove::verify);
}

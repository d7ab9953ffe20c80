#include "config/guidance_config.hpp"
#include "guidance_example/guidance_service.hpp"
#include "host/run.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::GuidanceConfig>(
      argc, argv,
      {"guidance_example", "Follows waypoints with the navigation state, as an example of its use."},
      [](host::ServiceHost& host, const config::GuidanceConfig& config) {
        const guidance::GuidanceService service(host, config);
        return host.run();
      });
}

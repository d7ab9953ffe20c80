#include "config/fusion/fusion_config.hpp"
#include "config/fusion/mounting_check.hpp"
#include "fusion/fusion_service.hpp"
#include "host/run.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::FusionConfig>(
      argc, argv,
      {"fusion",
       "Fuses inertial, acoustic, satellite, pressure and heading measurements into the navigation state."},
      [](host::ServiceHost& host, const config::FusionConfig& config) {
        fusion::FusionService service(host, config);
        return host.run();
      },
      [](const config::FusionConfig& config, const std::string& file, bool /*check*/) {
        config::refuse_second_mounting(config, file);
      });
}

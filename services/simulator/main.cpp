#include "config/scenario/simulator_config.hpp"
#include "host/run.hpp"
#include "simulator/simulator_service.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::SimulatorConfig>(
      argc, argv, {"simulator", "A simulated vehicle whose instruments speak their real protocols."},
      [](host::ServiceHost& host, const config::SimulatorConfig& config) {
        const simulator::SimulatorService service(host, config);
        return host.run();
      });
}

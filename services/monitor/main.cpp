#include "config/monitor_config.hpp"
#include "host/run.hpp"
#include "monitor/monitor_service.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::MonitorConfig>(
      argc, argv, {"monitor", "Watches GPS, alignment, sensors and services, and keeps the alarms.", true},
      [](host::ServiceHost& host, const config::MonitorConfig& config) {
        const monitor::MonitorService service(host, config);
        return host.run();
      });
}

#include "config/recorder_config.hpp"
#include "host/run.hpp"
#include "recorder/recorder_service.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::RecorderConfig>(
      argc, argv, {"recorder", "Records everything that is said on the vehicle network.", true},
      [](host::ServiceHost& host, const config::RecorderConfig& config) {
        const recorder::RecorderService service(host, config);
        return host.run();
      });
}

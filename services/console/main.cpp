#include "config/console_config.hpp"
#include "console/console_service.hpp"
#include "console/http/precautions.hpp"
#include "host/run.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::ConsoleConfig>(
      argc, argv,
      {"console", "Shows navigation to people: a web page with live data, and their orders to the vehicle.",
       true},
      [](host::ServiceHost& host, const config::ConsoleConfig& config) {
        const console::ConsoleService service(host, config);
        return host.run();
      },
      console::verify);
}

#pragma once

#include <functional>
#include <string>
#include <utility>

#include "config/service_config.hpp"
#include "host/service_host.hpp"

namespace fathom::host {

/// run() without the type of the configuration.
struct Prepared {
  config::CommonConfig common;
  std::string config_hash;
};
[[nodiscard]] int run_service(int argc, char** argv, const ServiceInfo& info,
                              const std::function<Prepared(const config::LoadRequest&)>& load,
                              const std::function<ExitCode(ServiceHost&)>& body);

/// The main of a service: `EXE --config FILE [--set key.sub=value ...] [--check] [--version]`.
///
/// Loads the configuration before anything starts and calls `body(host, config)`, which builds the service
/// and returns host.run(). What goes wrong becomes one line on standard error, `fathom-NAME: ...`, and the
/// exit code: 2 usage or configuration, 4 anything else. Config holds a member `common` and is instantiated
/// for config::load_service_config().
template <class Config, class Body>
[[nodiscard]] int run(int argc, char** argv, const ServiceInfo& info, Body&& body) {
  Config config{};
  return run_service(
      argc, argv, info,
      [&config](const config::LoadRequest& request) {
        auto loaded = config::load_service_config<Config>(request);
        config = std::move(loaded.value);
        return Prepared{config.common, std::move(loaded.hash)};
      },
      [&](ServiceHost& host) { return body(host, std::as_const(config)); });
}

}  // namespace fathom::host

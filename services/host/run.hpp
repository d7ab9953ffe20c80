#pragma once

#include <functional>
#include <string>
#include <utility>

#include "config/service_config.hpp"
#include "host/service_host.hpp"

namespace fathom::host {

/// The part of run() that does not depend on the type of the configuration.
struct Prepared {
  config::CommonConfig common;
  std::string config_hash;
  std::string instance{};  ///< name of this service where there may be several of its kind; else empty
  std::string discovery_listen{};  ///< where it is a discovery server; else empty
};
/// `explain` prints every key of the service's configuration.
[[nodiscard]] int run_service(int argc, char** argv, const ServiceInfo& info,
                              const std::function<std::string()>& explain,
                              const std::function<Prepared(const config::LoadRequest&, bool check)>& load,
                              const std::function<ExitCode(ServiceHost&)>& body);

/// The main of a service: `EXE --config FILE [--set key.sub=value ...] [--check]`, with `--vehicle FILE`
/// beneath or in place of --config, and `EXE --explain`, which prints the keys of FILE with their units,
/// ranges and defaults, or `EXE --version`.
///
/// Loads the configuration before anything starts and calls `body(host, config)`, which builds the service
/// and returns host.run(). An error becomes one line on standard error, `fathom-NAME: ...`, of a
/// configuration one for each mistake, and the exit code: 2 for usage or configuration, 4 for anything else.
/// Config holds a member `common`, a member `instance` where there may be several services of the kind,
/// `discovery_listen` where it is a discovery server, and is instantiated for config::load_service_config().
///
/// `verify(config, file, check)` checks the files that the configuration names, such as certificates, before
/// anything starts, and throws config::ConfigError. `check`: --check was given, which may be stricter than a
/// start.
template <class Config, class Body, class Verify>
[[nodiscard]] int run(int argc, char** argv, const ServiceInfo& info, Body&& body, Verify&& verify) {
  Config config{};
  return run_service(
      argc, argv, info, config::explain_service_config<Config>,
      [&](const config::LoadRequest& request, bool check) {
        auto loaded = config::load_service_config<Config>(request);
        config = std::move(loaded.value);
        verify(std::as_const(config), request.name(), check);
        Prepared prepared{config.common, std::move(loaded.hash)};
        if constexpr (requires { config.instance; }) prepared.instance = config.instance;
        if constexpr (requires { config.discovery_listen; })
          prepared.discovery_listen = config.discovery_listen;
        return prepared;
      },
      [&](ServiceHost& host) { return body(host, std::as_const(config)); });
}

/// The same for a service whose configuration names no files.
template <class Config, class Body>
[[nodiscard]] int run(int argc, char** argv, const ServiceInfo& info, Body&& body) {
  return run<Config>(argc, argv, info, std::forward<Body>(body),
                     [](const Config&, const std::string& /*file*/, bool /*check*/) {});
}

}  // namespace fathom::host

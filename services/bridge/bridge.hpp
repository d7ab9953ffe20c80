#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "bridge/sensor_channel.hpp"
#include "config/bridge/bridge_config.hpp"
#include "host/run.hpp"
#include "host/service_host.hpp"

namespace fathom::bridge {

/// Turns the bytes of any number of instruments into samples on the vehicle network. Each instrument has its
/// own thread and its own writer, so that a dead, silent, babbling or slow one disturbs no other; what is
/// wrong is said in the life sign, which is degraded then.
class Bridge {
 public:
  /// Publishes samples of the kinds that name this service in the table of kinds; others in the same stream
  /// are counted and ignored.
  Bridge(host::ServiceHost& host, const std::vector<config::SensorPlan>& plans, std::string_view role);
  ~Bridge();
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  /// Starts the instruments and runs until the service is stopped.
  [[nodiscard]] ExitCode run();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The whole main of a bridge.
template <class Config>
[[nodiscard]] int run_bridge(int argc, char** argv, const host::ServiceInfo& info) {
  return host::run<Config>(argc, argv, info,
                           [role = info.name](host::ServiceHost& host, const Config& config) {
                             Bridge bridge(host, config::sensor_plans(config), role);
                             return bridge.run();
                           });
}

}  // namespace fathom::bridge

#pragma once

#include <memory>

#include "config/console_config.hpp"
#include "host/service_host.hpp"

namespace fathom::console {

/// Listens to the vehicle, shows it to browsers, and passes on the orders of those who may give them. Writes
/// nothing but orders: navigation does not know whether it is there.
class ConsoleService {
 public:
  /// Installs its tick and its life sign in `host`, which must outlive it. Throws bus::BusError and
  /// config::ConfigError for tokens or a certificate that cannot be used.
  ConsoleService(host::ServiceHost& host, const config::ConsoleConfig& config);
  ~ConsoleService();
  ConsoleService(const ConsoleService&) = delete;
  ConsoleService& operator=(const ConsoleService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::console

#pragma once

#include <memory>
#include <string>

#include "config/doors/foxglove_config.hpp"
#include "host/service_host.hpp"

namespace fathom::foxglove {

/// Looks at the files that the configuration names. Throws config::ConfigError.
void verify(const config::FoxgloveConfig& config, const std::string& file, bool check);

/// Shows everything that is said on the vehicle network to clients of the Foxglove protocol. A topic is
/// listened to as long as a client subscribes to it.
class FoxgloveService {
 public:
  FoxgloveService(host::ServiceHost& host, const config::FoxgloveConfig& config);
  ~FoxgloveService();
  FoxgloveService(const FoxgloveService&) = delete;
  FoxgloveService& operator=(const FoxgloveService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::foxglove

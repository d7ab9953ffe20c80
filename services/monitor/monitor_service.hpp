#pragma once

#include <memory>

#include "config/monitor_config.hpp"
#include "host/service_host.hpp"

namespace fathom::monitor {

/// The monitor on the vehicle network. It listens to everything the vehicle publishes, judges it by the
/// host's monotonic clock, publishes MonitorStatus and Alarm, and takes acknowledgements. Its own
/// observations are enough: neither fusion nor any other service has to be alive.
class MonitorService {
 public:
  /// Installs its tick and its life sign in `host`, which must outlive it. Throws bus::BusError.
  MonitorService(host::ServiceHost& host, const config::MonitorConfig& config);
  ~MonitorService();
  MonitorService(const MonitorService&) = delete;
  MonitorService& operator=(const MonitorService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::monitor

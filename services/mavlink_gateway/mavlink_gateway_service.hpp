#pragma once

#include <memory>
#include <optional>
#include <string>

#include "config/doors/mavlink_gateway_config.hpp"
#include "host/service_host.hpp"
#include "mavlink/signing.hpp"

namespace fathom::mavlink_gateway {

/// The key that the configuration names; nothing where it names none. Throws config::ConfigError, `file`
/// being that of the configuration.
[[nodiscard]] std::optional<mavlink::Key> key_in(const config::MavlinkSigning& signing,
                                                 const std::string& file);

/// Tells an autopilot the navigation state (ODOMETRY, VISION_POSITION_ESTIMATE, GPS_INPUT), that it lives
/// (HEARTBEAT), and answers its questions about the time (TIMESYNC).
class MavlinkGatewayService {
 public:
  MavlinkGatewayService(host::ServiceHost& host, const config::MavlinkGatewayConfig& config);
  ~MavlinkGatewayService();
  MavlinkGatewayService(const MavlinkGatewayService&) = delete;
  MavlinkGatewayService& operator=(const MavlinkGatewayService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::mavlink_gateway

#pragma once

#include <memory>

#include "config/doors/ros2_gateway_config.hpp"
#include "host/service_host.hpp"

namespace fathom::ros2_gateway {

/// A node of ROS 2 that says what navigation says, and publishes topics of ROS 2 as instruments of the
/// vehicle. The graph of ROS 2 has a participant of its own: it may be in another domain, and is never
/// protected.
class GatewayService {
 public:
  GatewayService(host::ServiceHost& host, const config::Ros2GatewayConfig& config);
  ~GatewayService();
  GatewayService(const GatewayService&) = delete;
  GatewayService& operator=(const GatewayService&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fathom::ros2_gateway

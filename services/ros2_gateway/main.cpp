#include "config/doors/ros2_gateway_config.hpp"
#include "host/run.hpp"
#include "ros2_gateway/gateway_service.hpp"

int main(int argc, char** argv) {
  using namespace fathom;
  return host::run<config::Ros2GatewayConfig>(
      argc, argv, {"ros2_gateway", "Says navigation to ROS 2 and takes instruments from there."},
      [](host::ServiceHost& host, const config::Ros2GatewayConfig& config) {
        const ros2_gateway::GatewayService service(host, config);
        return host.run();
      });
}

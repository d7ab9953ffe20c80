#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::ImuBridgeConfig>(
      argc, argv, {"imu_bridge", "Publishes inertial sensors on the vehicle network."});
}

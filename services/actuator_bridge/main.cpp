#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::ActuatorBridgeConfig>(
      argc, argv, {"actuator_bridge", "Publishes propulsors and fins on the vehicle network."});
}

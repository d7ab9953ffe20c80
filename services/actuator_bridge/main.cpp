#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::ActuatorBridgeConfig, fathom::PropulsionSample,
                                    fathom::FinsSample>(
      argc, argv, {"actuator_bridge", "Publishes propulsors and fins on the vehicle network."});
}

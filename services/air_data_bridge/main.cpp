#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::AirDataBridgeConfig>(
      argc, argv, {"air_data_bridge", "Publishes airspeed and barometric height on the vehicle network."});
}

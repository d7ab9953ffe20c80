#include "bridge/bridge.hpp"
#include "config/bridge/range_config.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::RangeBridgeConfig>(
      argc, argv, {"range_bridge", "Publishes ranges to acoustic beacons on the vehicle network."});
}

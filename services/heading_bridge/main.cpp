#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::HeadingBridgeConfig>(
      argc, argv, {"heading_bridge", "Publishes compasses on the vehicle network."});
}

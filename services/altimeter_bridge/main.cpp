#include "bridge/bridge.hpp"
#include "config/bridge/altimeter_config.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::AltimeterBridgeConfig>(
      argc, argv, {"altimeter_bridge", "Publishes echo sounders that look down on the vehicle network."});
}

#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::DepthBridgeConfig>(
      argc, argv, {"depth_bridge", "Publishes depth and pressure sensors on the vehicle network."});
}

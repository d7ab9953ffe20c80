#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::GpsBridgeConfig>(
      argc, argv, {"gps_bridge", "Publishes satellite receivers on the vehicle network."});
}

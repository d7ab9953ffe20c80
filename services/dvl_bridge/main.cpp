#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::DvlBridgeConfig>(
      argc, argv, {"dvl_bridge", "Publishes Doppler velocity logs on the vehicle network."});
}

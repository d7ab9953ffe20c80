#include "bridge/bridge.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::UsblBridgeConfig>(
      argc, argv, {"usbl_bridge", "Publishes acoustic positioning on the vehicle network."});
}

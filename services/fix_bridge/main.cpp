#include "bridge/bridge.hpp"
#include "config/bridge/fix_config.hpp"

int main(int argc, char** argv) {
  return fathom::bridge::run_bridge<fathom::config::FixBridgeConfig>(
      argc, argv, {"fix_bridge", "Publishes positions that somebody tells on the vehicle network."});
}

#include "cli/bus_options.hpp"

#include <CLI/CLI.hpp>

namespace fathom::cli {

void add_bus_options(CLI::App& command, bus::ParticipantOptions& options, const std::string& identity) {
  command.add_option("--domain", options.domain, "DDS domain of the vehicle")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  command.add_option("--interface", options.interfaces, "Addresses of this host to use")
      ->capture_default_str();
  command.add_option("--peer", options.peers, "Addresses to look for the vehicle at")->capture_default_str();
  command.add_option("--discovery-server", options.discovery_servers,
                     "address:port of each fathom-discovery, where the vehicle uses them");
  command.add_option("--profiles", options.profiles_dir, "Folder of the QoS XML files");
  options.security.identity = identity;
  command
      .add_option("--security", options.security.folder,
                  "Folder of the credentials, where the vehicle network is protected")
      ->envname("FATHOM_SECURITY_DIR");
  command.add_option("--identity", options.security.identity, "Whose credentials in that folder")
      ->capture_default_str();
}

}  // namespace fathom::cli

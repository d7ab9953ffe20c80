#include "live/security_options.hpp"

#include <CLI/CLI.hpp>

namespace fathom::cli {

void add_security_options(CLI::App& command, bus::SecurityOptions& security) {
  security.identity = "cli";
  command
      .add_option("--security", security.folder,
                  "Folder of the credentials, where the vehicle network is protected")
      ->envname("FATHOM_SECURITY_DIR");
  command.add_option("--identity", security.identity, "Whose credentials in that folder")
      ->capture_default_str();
}

}  // namespace fathom::cli

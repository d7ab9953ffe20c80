#include "demo/options.hpp"

#include <CLI/CLI.hpp>

#include "runtime/build_info.hpp"

namespace fathom::demo {

Parsed parse(int argc, char** argv) {
  Parsed out;
  Options& options = out.options;
  CLI::App app{
      "Shows a vehicle navigating: simulated instruments, bridges, fusion, monitor and guidance over DDS.\n"
      "Exit code 0 only if every service stayed healthy and the scenario's limits held."};
  app.name("deploy/demo");
  app.set_version_flag("--version", "fathom-demo " + std::string(runtime::version()));
  auto* scenario =
      app.add_option("--scenario", options.scenario, "name of a file in deploy/config/scenarios, or a file")
          ->capture_default_str();
  auto* dataset =
      app.add_option("--dataset", options.dataset, "play this recorded vehicle through the same bridges")
          ->check(CLI::ExistingDirectory)
          ->excludes(scenario);
  app.add_option("--config", options.config, "fusion configuration for --dataset")
      ->check(CLI::ExistingFile)
      ->needs(dataset);
  app.add_option("--duration", options.duration_s,
                 "vehicle seconds; default: as the scenario or the data set says")
      ->check(CLI::Range(1.0, 1e6));
  app.add_option("--speed", options.speed, "vehicle seconds per second")->check(CLI::Range(0.1, 100.0));
  app.add_option(
      "--expect-alarm", options.expected_alarms,
      "name of an alarm that does not fail the run; with * at its end for all that begin so; may be "
      "repeated");
  app.add_option("--report", options.report, "write the report to this file");
  app.add_option("--commands", options.commands,
                 "start nothing: write the services' command lines to commands.txt in this folder")
      ->check(CLI::ExistingDirectory);
  app.add_option("--domain", options.domain, "DDS domain")->check(CLI::Range(0, 230));
  app.add_option("--interface", options.interfaces, "address of this host that DDS binds; may be repeated")
      ->check(CLI::ValidIPV4)
      ->capture_default_str();
  app.add_option("--peer", options.peers, "address asked for discovery besides multicast; may be repeated")
      ->check(CLI::ValidIPV4)
      ->capture_default_str();
  app.add_flag("--console,!--no-console", options.console,
               "with the operator console, where this build has one");
  app.add_flag("--record,!--no-record", options.record, "with the recorder");
  app.add_option(
      "--recordings", options.recordings,
      "folder of recordings; default: fathom-recordings-UID/DOMAIN in the system's temporary folder");
  app.add_flag("--standby", options.standby, "with a second fusion that takes over when the first one dies");
  app.add_flag("--secure", options.secure,
               "on a protected network: identities, permissions and encryption, made for this run");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& answered) {
    out.exit = app.exit(answered);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    out.exit = static_cast<int>(ExitCode::bad_configuration);
  }
  return out;
}

}  // namespace fathom::demo

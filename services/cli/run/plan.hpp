#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/json/error.hpp"
#include "launch/supervisor.hpp"

namespace fathom::cli {

/// What `fathom run` is asked for.
struct RunRequest {
  std::string vehicle;                ///< its file
  std::filesystem::path folder;       ///< of logs and of what is written where nobody said another place
  std::filesystem::path executables;  ///< where the services lie
  std::string record;                 ///< folder of the recorder; empty: as the vehicle says
  std::vector<std::string> sets;      ///< of every service, or with a service's name before the key
  std::vector<std::string> without;   ///< services, or single ones of several fusions
};

/// One service of the run.
struct RunService {
  std::string service;  ///< its kind, e.g. "fusion"; the program's name is its own among several
  launch::Program program;
  config::LoadRequest configuration;
};

/// Everything that runs, worked out before anything starts.
struct RunPlan {
  std::string vehicle;               ///< its name
  std::vector<RunService> services;  ///< in the order of their start: who listens before who speaks
};

/// The services that the vehicle needs on this machine: every fusion of `roles`, the monitor, the console,
/// the bridges of its enabled instruments, and what `services` or `roles.expected` name. The simulator stands
/// for instruments and is never one of them. Throws config::ConfigError about the vehicle's file, Failure
/// about the command line.
[[nodiscard]] RunPlan plan_run(const RunRequest& request);

/// Where the console is found; empty: none runs. Its configuration has been checked.
[[nodiscard]] std::string console_address(const RunPlan& plan);

/// The command that says how the vehicle does. The configurations have been checked.
[[nodiscard]] std::string status_command(const RunPlan& plan);

}  // namespace fathom::cli

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/exit_code.hpp"

namespace fathom::demo {

struct Options {
  std::string scenario = "survey";
  std::string dataset;      ///< folder of a recorded vehicle; empty: simulate
  std::string config;       ///< fusion configuration for a data set; empty: chosen by the folder's name
  double duration_s = 0.0;  ///< vehicle time; 0: as the scenario or the data set says
  double speed = 1.0;
  std::string commands;  ///< folder to write the services' command lines and the vehicle's file into,
                         ///< starting nothing; empty: run
  std::vector<std::string> expected_alarms;  ///< besides those of the scenario
  std::string report;                        ///< file for the report; empty: none
  int domain = 0;
  std::vector<std::string> interfaces{"127.0.0.1"};  ///< addresses of this host that DDS binds
  std::vector<std::string> peers{"127.0.0.1"};       ///< asked for discovery besides multicast
  bool console = true;
  bool record = true;
  std::string recordings;  ///< folder; empty: a folder of the user's below the temporary one, for each domain
  bool standby = false;    ///< with a second fusion that takes over when the first one dies
  bool secure = false;     ///< on a protected network, with credentials made for this run
};

/// What the command line asks for, or the exit code when it has been answered already (--help, bad usage).
struct Parsed {
  Options options;
  std::optional<int> exit;
};
[[nodiscard]] Parsed parse(int argc, char** argv);

}  // namespace fathom::demo

#pragma once

#include <optional>
#include <string>

#include "base/exit_code.hpp"

namespace fathom::demo {

struct Options {
  std::string scenario = "survey";
  std::string dataset;      ///< folder of a recorded vehicle; empty: simulate
  std::string config;       ///< fusion configuration for a data set; empty: chosen by the folder's name
  double duration_s = 0.0;  ///< vehicle time; 0: as the scenario or the data set says
  double speed = 1.0;
  std::string report;  ///< file for the report; empty: none
  int domain = 0;
  bool console = true;
};

/// What the command line asks for, or the exit code when it has been answered already (--help, bad usage).
struct Parsed {
  Options options;
  std::optional<int> exit;
};
[[nodiscard]] Parsed parse(int argc, char** argv);

}  // namespace fathom::demo

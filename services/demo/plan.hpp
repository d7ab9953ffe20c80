#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "demo/options.hpp"
#include "demo/report.hpp"
#include "demo/run_record.hpp"
#include "launch/supervisor.hpp"

namespace fathom::demo {

/// Everything that a run consists of, worked out before anything starts.
struct Plan {
  std::string title;        ///< scenario name, or the data set's folder
  double duration_s = 0.0;  ///< vehicle time
  TimeNs epoch_ns = 0;      ///< UTC at which an accelerated clock starts; 0: the host's own clock
  std::vector<launch::Program> programs;  ///< in the order of their start
  std::string console;  ///< address of the operator console, with the right to give orders; empty: none
  std::filesystem::path recordings;  ///< folder of the recorder; empty: nothing is recorded
  std::string credentials;           ///< folder of the run's own; empty: the network is not protected
  RunRecord::Options record;
  Demands demands;
};

/// `run_directory`: for pseudo-terminals and logs. Throws config::ConfigError or dataset::DatasetError.
[[nodiscard]] Plan make_plan(const Options& options, const std::filesystem::path& run_directory);

}  // namespace fathom::demo

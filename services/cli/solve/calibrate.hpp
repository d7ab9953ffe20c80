#pragma once

#include <string>

#include "cli/solve/run.hpp"

namespace fathom::cli {

/// Throws Failure where the configuration or the data set lacks what the calibration begins with.
void check_calibration(const SolveRun& solve_run, const std::string& directory,
                       const std::string& config_file);

/// One more run of the data set, without the vehicle model, and the coefficients that its navigated
/// velocity asks for (HYD-5): a coefficient file for the engine with the sigma of each value. Returns what is
/// told people about it. Throws Failure. After check_calibration().
[[nodiscard]] std::string calibrate_hydro(const SolveRun& solve_run, const std::string& directory,
                                          const std::string& out_file);

}  // namespace fathom::cli

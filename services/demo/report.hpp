#pragma once

#include <string>
#include <vector>

#include "demo/judgement.hpp"

namespace fathom::demo {

/// The JSON of the contract, with "findings" and "restarts" besides.
[[nodiscard]] std::string report_json(const std::string& scenario, double duration_s, const Observation& seen,
                                      const Demands& demands, const std::vector<Finding>& findings,
                                      const std::string& recording);

/// One line for the terminal: where we are, how good, what is wrong.
[[nodiscard]] std::string status_line(double elapsed_s, const Observation& seen);

}  // namespace fathom::demo

#pragma once

namespace fathom {

/// Exit codes of every executable.
enum class ExitCode : int {
  done = 0,
  no = 1,                 ///< the answer is "no" or "unhealthy"
  bad_configuration = 2,  ///< bad usage or configuration
  bad_input = 3,          ///< bad input data
  runtime_failure = 4,
};

}  // namespace fathom

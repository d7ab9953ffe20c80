#pragma once

#include <string>
#include <vector>

#include "launch/supervisor.hpp"

namespace fathom::launch {

/// What services say against their configuration, each complaint once.
struct Complaint {
  std::vector<std::string> names;  ///< of the programs that say it
  std::string text;                ///< file, key, value and what was expected
};

/// Asks every program with `--check`, side by side. Empty: all may start. Throws std::system_error when one
/// cannot be asked.
[[nodiscard]] std::vector<Complaint> complaints_of(const std::vector<Program>& programs);

}  // namespace fathom::launch

#pragma once

#include <string>

#include "samples/position/fix.hpp"
#include "samples/verdict.hpp"

namespace fathom::orders {

/// What became of a told position, in one line for a person.
[[nodiscard]] std::string in_words(const FixSample& fix, const Verdict& verdict);
/// The same for scripts: one line of JSON.
[[nodiscard]] std::string json_line(const FixSample& fix, const Verdict& verdict);

}  // namespace fathom::orders

#pragma once

#include <string>

#include "samples/nav_state.hpp"
#include "samples/verdict.hpp"

namespace fathom::cli {

/// The first field in which two of them differ, with both values; empty when they are equal to the bit. All
/// NaN are one, since their bits do not travel through arithmetic alike everywhere.
[[nodiscard]] std::string first_difference(const NavState& recorded, const NavState& computed);
[[nodiscard]] std::string first_difference(const Verdict& recorded, const Verdict& computed);

/// What one is called in a sentence.
[[nodiscard]] std::string in_words(const NavState& state);
[[nodiscard]] std::string in_words(const Verdict& verdict);

}  // namespace fathom::cli

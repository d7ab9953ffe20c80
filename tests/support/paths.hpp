#pragma once

#include <string>

namespace fathom::test {

// Where things are. They are functions of one source, so that a compiler cache knows all others again in
// another checkout.
[[nodiscard]] std::string source_dir();    ///< this checkout
[[nodiscard]] std::string binary_dir();    ///< its build
[[nodiscard]] std::string captures_dir();  ///< recordings of instruments; may be missing
[[nodiscard]] std::string datasets_dir();  ///< recorded vehicles; may be missing
[[nodiscard]] std::string vectors_dir();   ///< what is known by other means, in git

}  // namespace fathom::test

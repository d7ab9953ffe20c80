#pragma once

#include <string>

namespace fathom::fusion {

/// Identity of this executable: its release and a checksum of its file.
[[nodiscard]] std::string build_of_this_executable();

}  // namespace fathom::fusion

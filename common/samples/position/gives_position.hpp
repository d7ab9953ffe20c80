#pragma once

#include "samples/nav_state.hpp"

namespace fathom {

/// Whether a state of this mode has a position to be used. While aligning only its attitude is.
[[nodiscard]] constexpr bool gives_position(NavMode mode) {
  return mode != NavMode::none && mode != NavMode::aligning;
}

}  // namespace fathom

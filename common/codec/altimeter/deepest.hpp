#pragma once

namespace fathom::codec {

/// No bottom is farther from an echo sounder.
inline constexpr double kDeepestBottom_m = 12'000.0;

}  // namespace fathom::codec

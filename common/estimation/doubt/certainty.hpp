#pragma once

#include <cstdint>

namespace fathom::estimation {

/// So many sigmas leave no doubt that what was said is wrong.
inline constexpr double kCertain = 5.0;
/// A large error is found in steps. One that is never found is another one.
inline constexpr std::uint32_t kMostCorrections = 3;

}  // namespace fathom::estimation

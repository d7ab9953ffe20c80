#pragma once

#include <cstddef>

namespace fathom::health {

/// Their names come from the network: bounded.
inline constexpr std::size_t kMaxReceivers = 16;

}  // namespace fathom::health

#pragma once

#include <string>

#include "samples/command.hpp"

namespace fathom::estimation {

/// Why an order is none that an engine can follow, in words: what is wrong with it and what was expected;
/// empty when it is one. Whether its target is there is not looked at.
[[nodiscard]] std::string objection_to(const Command& order);

}  // namespace fathom::estimation

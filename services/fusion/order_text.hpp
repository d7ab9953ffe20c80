#pragma once

#include <string>

#include "estimation/engine/order.hpp"
#include "samples/command.hpp"

namespace fathom::fusion {

/// An order in words for the log: what was ordered, of which source, and who ordered it.
[[nodiscard]] std::string in_words(const Command& order);
/// What became of an order, in words for the log.
[[nodiscard]] std::string in_words(const estimation::OrderOutcome& outcome);

}  // namespace fathom::fusion

#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fathom {

/// The word of `words` that a person may have meant by `given`: the one with the fewest letters changed, left
/// out, added or swapped with their neighbour, the first of equals. Nothing where that is more than a third
/// of the letters, and at least one is always forgiven.
[[nodiscard]] std::optional<std::string> nearest(std::string_view given, std::span<const std::string> words);

}  // namespace fathom

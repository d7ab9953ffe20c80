#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fathom {

/// The word of `words` that a person may have meant by `given`: the one with a single letter changed, left
/// out, added or swapped with its neighbour; else the only one that has all parts of `given` between its own
/// underscores ("vn100": "vectornav_vn100"); else the one with the fewest such letters, the first of equals.
/// Nothing where those are more than a third of the letters, and at least one is always forgiven.
[[nodiscard]] std::optional<std::string> nearest(std::string_view given, std::span<const std::string> words);

}  // namespace fathom

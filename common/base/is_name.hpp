#pragma once

#include <algorithm>
#include <string_view>

#include "base/name.hpp"

namespace fathom {

/// Whether `text` may name a vehicle, an instrument or a service: 1 to 31 letters, digits, '_', '-' or '.',
/// not beginning with '.'. Names become topic keys, file names, metric labels and words on screens.
[[nodiscard]] constexpr bool is_name(std::string_view text) {
  const auto safe = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !text.empty() && text.size() <= Name::kCapacity && text.front() != '.' &&
         std::all_of(text.begin(), text.end(), safe);
}
inline constexpr const char* kNameForm = "1 to 31 letters, digits, '_', '-' or '.', not beginning with '.'";

}  // namespace fathom

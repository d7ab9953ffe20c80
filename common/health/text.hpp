#pragma once

#include <string>
#include <string_view>

#include "base/name.hpp"

namespace fathom::health {

/// Prints into a string as printf does, for the texts of alarms.
[[nodiscard]] std::string sentence(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// A duration for operators: "12.3 s", "4 min 05 s" or "2 h 03 min".
[[nodiscard]] std::string duration_text(double seconds);

/// The key of an alarm, "kind:name". A key holds Name::kCapacity bytes. A name that is too long keeps its
/// head and ends in '~' and two hexadecimal digits of a hash, so that two long names stay apart.
[[nodiscard]] Name alarm_key(std::string_view kind, std::string_view name);

}  // namespace fathom::health

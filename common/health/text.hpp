#pragma once

#include <string>
#include <string_view>

#include "base/name.hpp"

namespace fathom::health {

/// printf into a string; for the one-sentence texts of alarms.
[[nodiscard]] std::string sentence(const char* format, ...) __attribute__((format(printf, 1, 2)));

/// "12.3 s", "4 min 05 s" or "2 h 03 min": what an operator reads at a glance.
[[nodiscard]] std::string duration_text(double seconds);

/// "kind:name" as the key of an alarm. A key holds Name::kCapacity bytes: a name too long for it keeps its
/// head and ends in '~' and two hexadecimal digits of a hash, so that two long names stay apart.
[[nodiscard]] Name alarm_key(std::string_view kind, std::string_view name);

}  // namespace fathom::health

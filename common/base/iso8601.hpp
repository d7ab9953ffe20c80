#pragma once

#include <optional>
#include <string>

#include "base/time.hpp"

namespace fathom {

/// The instant that to_iso8601() wrote, with any number of decimals: 2026-01-31T12:00:00.5Z. Nothing for
/// other texts.
[[nodiscard]] std::optional<TimeNs> from_iso8601(const std::string& text);

}  // namespace fathom

#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "status/view.hpp"

namespace fathom::status {

/// Whether navigation can be relied upon, in the order of getting worse.
enum class TrustLevel : std::uint8_t { good = 0, caution = 1, bad = 2 };
[[nodiscard]] std::string_view to_string(TrustLevel level);

/// The first line for an operator: whether navigation can be relied upon, why not, for how long, and what to
/// do.
struct Trust {
  TrustLevel level = TrustLevel::bad;
  std::string
      sentence;        ///< without full stop, e.g. "Dead reckoning with DVL, GPS gone 4 min 12 s, 95 % 18 m"
  std::string advice;  ///< a sentence, or empty when there is nothing to be done
};

/// `fresh_s`: a navigation state older than this does not count.
[[nodiscard]] Trust judge_trust(const StatusView& view, double fresh_s);

}  // namespace fathom::status

#pragma once

// Strict JSON for what comes from outside: configuration files, overrides, orders.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace fathom::config {

/// Objects and arrays inside each other, at most.
inline constexpr std::size_t kJsonLevels = 32;

/// Why a text was not taken.
struct JsonFault {
  enum class Kind {
    syntax,     ///< it is not JSON
    depth,      ///< more than kJsonLevels objects and arrays inside each other
    duplicate,  ///< a key stands twice in one object
    number      ///< a number that a double cannot hold
  };
  Kind kind = Kind::syntax;
  std::string key;          ///< dotted path of the place, e.g. "bus.peers.1"; empty at the top
  std::string is;           ///< what stands there, e.g. "1e400"; for syntax the parser's words
  std::string expectation;  ///< e.g. "each key once"; empty for syntax
  std::ptrdiff_t line = 1;  ///< of a syntax fault, from 1
};

struct StrictJson {
  nlohmann::json value;            ///< null where there is a fault
  std::optional<JsonFault> fault;  ///< the first one
};

/// Parses a whole text. It never throws and never follows nesting deeper than kJsonLevels.
[[nodiscard]] StrictJson parse_strict(std::string_view text);

/// "KEY: is IS, expected EXPECTATION", or the parser's words; no full stop.
[[nodiscard]] std::string describe(const JsonFault& fault);

/// The text without characters that would break a line of a log: each becomes '?'.
[[nodiscard]] std::string one_line(std::string text);

}  // namespace fathom::config

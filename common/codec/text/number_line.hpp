#pragma once

#include <optional>
#include <string_view>

#include "codec/framer.hpp"

namespace fathom::codec {

/// What the text protocols of instruments share that tell one number a line.

inline constexpr std::size_t kMaxNumberLine = 128;

/// One line, from where the last one ended to its CR or LF. A line longer than kMaxNumberLine is refused.
[[nodiscard]] Probe probe_number_line(Bytes front);

/// What a line says; neither where it begins otherwise than expected.
struct LineNumber {
  std::optional<double> value;
  std::optional<RejectReason> refused;
};

/// Of `prefix`, blanks, a decimal number, then nothing, a unit, or a separator (blank, comma, semicolon, `*`)
/// and anything. A line that begins with `$` and ends with `*hh` must have the right NMEA checksum.
[[nodiscard]] LineNumber number_of_line(std::string_view line, std::string_view prefix);

}  // namespace fathom::codec

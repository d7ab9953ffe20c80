#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "codec/framer.hpp"

namespace fathom::codec {

inline constexpr std::size_t kMaxNumberLine = 128;

/// One line, from where the last one ended to its CR or LF. A line longer than kMaxNumberLine is refused.
[[nodiscard]] Probe probe_number_line(Bytes front);

/// Instruments without a protocol of their own that tell one number a line: `prefix`, blanks, a decimal
/// number, then nothing, a unit, or a separator (blank, comma, semicolon, `*`) and anything. Lines that begin
/// otherwise are good and carry no sample. A line that begins with `$` and ends with `*hh` must have the
/// right NMEA checksum.
class NumberLines : public Framer {
 protected:
  explicit NumberLines(std::string_view prefix)
      : Framer(2 * kMaxNumberLine, LineEnds::belong_to_frames), prefix_(prefix) {}

  [[nodiscard]] Probe probe(Bytes front) const final { return probe_number_line(front); }
  Outcome decode(Bytes frame, std::uint64_t offset, Sink& sink) final;

  /// The sample that the number makes, or why it makes none.
  virtual std::optional<RejectReason> read(double number, AnySample& sample) const = 0;

 private:
  std::string prefix_;
};

}  // namespace fathom::codec

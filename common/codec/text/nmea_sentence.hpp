#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "base/time.hpp"
#include "codec/framer.hpp"

namespace fathom::codec {

/// Longest sentence looked at. The standard says 82 characters; receivers send several hundred.
inline constexpr std::size_t kMaxSentence = 1024;

/// One NMEA 0183 sentence, cut into its fields. The views point into the frame.
struct Sentence {
  static constexpr std::size_t kMaxFields = 128;

  std::string_view talker;  ///< "GP"; empty for a proprietary sentence
  std::string_view type;    ///< "GGA"; the whole address for a proprietary one: "PSIMSSB"
  std::array<std::string_view, kMaxFields> field;
  std::size_t fields = 0;  ///< may exceed kMaxFields; only the first ones are kept
};

/// Finds the sentence at the front: `$` or `!`, an address of upper-case letters and digits, fields, `*hh`.
/// The frame ends after the two digits, so that nothing waits for the line end. Without a checksum it ends at
/// the line end, where the configuration allows that.
[[nodiscard]] Probe probe_sentence(Bytes front, bool require_checksum);

/// The rest of it: what follows `from` bytes that begin a sentence.
[[nodiscard]] Probe probe_fields(Bytes front, std::size_t from, bool require_checksum);

/// XOR of all bytes.
[[nodiscard]] std::uint8_t nmea_checksum(std::string_view between_dollar_and_star);

/// Cuts a frame that probe_sentence has accepted.
[[nodiscard]] Sentence split_sentence(Bytes frame);

/// Reads fields one by one and remembers the first thing that was wrong. Empty fields are unknown, not wrong.
class FieldReader {
 public:
  explicit FieldReader(const Sentence& sentence) : sentence_(sentence) {}

  [[nodiscard]] std::string_view text(std::size_t index) const;
  /// kUnknown where empty; `field` where not a decimal number, `out_of_range` outside [low, high].
  [[nodiscard]] double number(std::size_t index, double low, double high);
  /// The letter itself, '\0' where empty; `field` where it is not one of `allowed`.
  [[nodiscard]] char letter(std::size_t index, std::string_view allowed);
  /// hhmmss[.s...] as time of day; nothing where empty.
  [[nodiscard]] std::optional<DurationNs> time_of_day(std::size_t index);
  /// ddmm.m... and its hemisphere in the next field, radians; kUnknown where either is empty.
  [[nodiscard]] double latitude(std::size_t index);
  [[nodiscard]] double longitude(std::size_t index);
  /// Angle in degrees and the letter E (positive) or W in the next field, radians.
  [[nodiscard]] double east_west(std::size_t index, double limit_deg);

  void refuse(RejectReason reason);
  [[nodiscard]] const std::optional<RejectReason>& refused() const { return refused_; }

 private:
  double angle(std::size_t index, std::string_view hemispheres, double limit_deg);

  const Sentence& sentence_;
  std::optional<RejectReason> refused_;
};

}  // namespace fathom::codec

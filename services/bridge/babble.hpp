#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/time.hpp"

namespace fathom::bridge {

/// A watch over a line that speaks and is not understood, as by a wrong baud rate or another protocol. It
/// says so once it has lasted, and again at long intervals. Pure: time is an argument.
class Babble {
 public:
  static constexpr std::size_t kShown = 16;  ///< bytes
  static constexpr DurationNs kAgain_ns = 600 * kNsPerSecond;

  /// What came since the line was understood last, or since it was said last.
  struct Report {
    std::uint64_t bytes = 0;
    double seconds = 0.0;
    std::string first_bytes;  ///< in hexadecimal
  };

  /// `after_ns`: how long bytes must have been coming that belong to no good frame.
  explicit Babble(DurationNs after_ns) : after_ns_(after_ns) {}

  /// One read, and how many of the bytes that have come so far turned out to belong to no good frame with it.
  [[nodiscard]] std::optional<Report> not_understood(std::span<const std::uint8_t> bytes, std::uint64_t waste,
                                                     TimeNs now_ns);
  /// A good frame came. True when it had been said that there was none.
  bool understood();
  /// Another connection; what was said of the one before is not said of it at once.
  void forget();

 private:
  DurationNs after_ns_;
  std::optional<TimeNs> since_ns_;  ///< of the first waste
  std::optional<TimeNs> said_ns_;
  TimeNs counted_ns_ = 0;  ///< from when on the bytes are counted
  std::uint64_t bytes_ = 0;
  std::array<std::uint8_t, kShown> first_{};
  std::size_t first_count_ = 0;
};

}  // namespace fathom::bridge

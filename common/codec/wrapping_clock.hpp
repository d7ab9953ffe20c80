#pragma once

#include <cstdint>

namespace fathom::codec {

/// A device's counter of 32 bits, carried on where it begins again. A reading behind the one before counts
/// backwards.
class WrappingClock {
 public:
  /// The counter without its return to 0.
  std::int64_t follow(std::uint32_t reading) {
    const std::uint32_t passed = reading - static_cast<std::uint32_t>(last_);
    last_ = known_ ? last_ + static_cast<std::int32_t>(passed) : reading;
    known_ = true;
    return last_;
  }
  [[nodiscard]] std::int64_t last() const { return last_; }

 private:
  std::int64_t last_ = 0;
  bool known_ = false;
};

}  // namespace fathom::codec

#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/time.hpp"
#include "mavlink/frame.hpp"

/// Signatures of MAVLink 2: who has the key of 32 bytes may speak, and nothing that was said once counts
/// twice.
namespace fathom::mavlink {

using Key = std::array<std::uint8_t, 32>;

/// Of 64 hexadecimal digits, white space around them left out. The error says what was expected.
[[nodiscard]] Result<Key> key_of(const std::string& text);

/// Units of 10 us since 2015-01-01 UTC.
[[nodiscard]] std::uint64_t signing_time(TimeNs utc_ns);

class Signer {
 public:
  Signer(const Key& key, std::uint8_t link) : key_(key), link_(link) {}

  /// Appends the signature to a frame that frame_of() made with kFlagSigned. The time never stands still or
  /// goes back, whatever the clock does.
  void sign(std::vector<std::uint8_t>& frame, TimeNs utc_ns);

 private:
  Key key_;
  std::uint8_t link_;
  std::uint64_t last_ = 0;
};

enum class Trust : std::uint8_t {
  trusted,
  not_signed,
  wrong_signature,
  said_before,  ///< not newer than the last one of its sender and link
  too_old,      ///< the first of a sender, more than a minute behind our clock
};
[[nodiscard]] std::string_view to_string(Trust trust);

class Verifier {
 public:
  explicit Verifier(const Key& key) : key_(key) {}

  [[nodiscard]] Trust judge(const Frame& frame, TimeNs utc_ns);

 private:
  static constexpr std::size_t kMostSenders = 64;  // they come from outside: bounded

  Key key_;
  std::map<std::array<std::uint8_t, 3>, std::uint64_t> last_;  ///< by system, component and link
};

}  // namespace fathom::mavlink

#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/time.hpp"
#include "bus/detail/network/peer_book.hpp"
#include "bus/participant.hpp"

namespace fathom::bus::detail {

/// Who on a protected network has not proved an identity. What such a participant says of itself is hearsay:
/// names are cut and cleaned, and only so many are remembered, for anybody can invent more. Thread-safe.
class StrangerBook {
 public:
  static constexpr std::size_t kMost = 64;  ///< remembered at a time; the rest is only counted
  /// A participant that has announced itself this long without proving its identity is refused in our eyes:
  /// the one that sends the first message of a handshake is not told when the other likes none of it.
  static constexpr DurationNs kPatience = 20 * kNsPerSecond;

  /// `now_ns` is a monotonic clock.
  explicit StrangerBook(std::function<TimeNs()> now_ns = {});

  /// `prefix` announced itself. Returns what it called itself when that is the first news of one that has
  /// proved its identity already.
  [[nodiscard]] std::optional<Peer> announced(const GuidPrefix& prefix, const Peer& peer,
                                              const std::string& address, bool offers_identity);
  /// Those whom nobody has waited for long enough until now and who are refused from now on.
  std::vector<Stranger> overdue();
  /// It proved its identity. Returns what it called itself before, when that is known.
  std::optional<Peer> admitted(const GuidPrefix& prefix);
  /// It failed to, or was found to have no valid permissions. Returns the stranger to be reported.
  Stranger refused(const GuidPrefix& prefix, const std::string& why);
  /// Returns the stranger that left, if it was one.
  std::optional<Stranger> gone(const GuidPrefix& prefix);

  [[nodiscard]] std::vector<Stranger> present() const;

 private:
  struct Entry {
    Peer peer;
    Stranger stranger;
    TimeNs since_ns = 0;
    bool refused = false;
  };

  mutable std::mutex mutex_;
  std::map<GuidPrefix, Entry> entries_;  ///< not admitted
  std::map<GuidPrefix, bool> admitted_;  ///< and whether what it called itself is known
  std::function<TimeNs()> now_ns_;
};

/// Printable ASCII of `text`, at most 40 characters.
[[nodiscard]] std::string cleaned(const std::string& text);

/// What Fast DDS says of others in its log and nowhere else.
struct Denial {
  GuidPrefix who{};
  bool whole = false;  ///< it may take no part at all: its permissions are not valid
  bool writes = false;
  std::string topic;  ///< that it may not write or read; empty when `whole`
};
/// Nothing when the message is about something else.
[[nodiscard]] std::optional<Denial> parse_denial(const std::string& message);

}  // namespace fathom::bus::detail

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

/// The participants on a protected network that have not proved an identity. Their names are their own
/// claims: names are cut and cleaned, and only a limited number is remembered, because anybody can invent
/// more. Thread-safe.
class StrangerBook {
 public:
  static constexpr std::size_t kMost = 64;  ///< remembered at a time; the rest is only counted
  /// Time after which a participant that announced itself and proved no identity counts as refused. Fast DDS
  /// does not tell the side that began a handshake when the other side refuses it.
  static constexpr DurationNs kPatience = 20 * kNsPerSecond;

  /// How long one is remembered that was refused before it announced itself. Fast DDS 3 tells of nobody who
  /// has not proved an identity, neither the name nor that it leaves.
  static constexpr DurationNs kMemory = 300 * kNsPerSecond;

  /// `now_ns` is a monotonic clock.
  explicit StrangerBook(std::function<TimeNs()> now_ns = {});

  /// `prefix` announced itself. Returns its name when it has proved its identity already and this is its
  /// first announcement.
  [[nodiscard]] std::optional<Peer> announced(const GuidPrefix& prefix, const Peer& peer,
                                              const std::string& address, bool offers_identity);
  /// Participants whose time for a proof has run out since the last call, and who count as refused now.
  std::vector<Stranger> overdue();
  /// It proved its identity. Returns its announced name when that is known.
  std::optional<Peer> admitted(const GuidPrefix& prefix);
  /// Its proof failed, or it has no valid permissions. Returns the stranger to be reported.
  Stranger refused(const GuidPrefix& prefix, const std::string& why);
  /// Those without an announcement that were refused too long ago to be remembered.
  std::vector<Stranger> forgotten();
  /// Returns the stranger that left, if it was one.
  std::optional<Stranger> gone(const GuidPrefix& prefix);

  [[nodiscard]] std::vector<Stranger> present() const;

 private:
  struct Entry {
    Peer peer;
    Stranger stranger;
    TimeNs since_ns = 0;
    bool refused = false;
    bool announced = true;
  };

  /// Makes room for one more. False where all may yet prove themselves.
  bool make_room();

  mutable std::mutex mutex_;
  std::map<GuidPrefix, Entry> entries_;  ///< not admitted
  std::map<GuidPrefix, bool> admitted_;  ///< and whether their names are known
  std::function<TimeNs()> now_ns_;
};

/// Printable ASCII of `text`, at most 40 characters.
[[nodiscard]] std::string cleaned(const std::string& text);

/// A refusal that Fast DDS reports in its log and nowhere else.
struct Denial {
  GuidPrefix who{};
  bool whole = false;  ///< it may not take part at all, because its permissions are not valid
  bool writes = false;
  std::string topic;  ///< topic that it may not write or read; empty when `whole`
};
/// Nothing when the message is about something else.
[[nodiscard]] std::optional<Denial> parse_denial(const std::string& message);

}  // namespace fathom::bus::detail

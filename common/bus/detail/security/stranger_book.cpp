#include "bus/detail/security/stranger_book.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "base/clock.hpp"

namespace fathom::bus::detail {
namespace {

constexpr std::size_t kLongestName = 40;

Stranger to_stranger(const GuidPrefix& prefix, const Peer& peer, const std::string& address) {
  return {cleaned(peer.name), hex(prefix), cleaned(address), {}};
}

/// Reads "01.0f.…" up to '|'.
bool read_prefix(std::string_view text, GuidPrefix& prefix) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < prefix.size(); ++i) {
    const auto [next, error] = std::from_chars(at, end, prefix[i], 16);
    if (error != std::errc() || next == end || *next != (i + 1 < prefix.size() ? '.' : '|')) return false;
    at = next + 1;
  }
  return true;
}

}  // namespace

std::string cleaned(const std::string& text) {
  std::string out = text.substr(0, kLongestName);
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < 0x20 || c > 0x7e || c == '\''; }, '?');
  return out;
}

StrangerBook::StrangerBook(std::function<TimeNs()> now_ns) : now_ns_(std::move(now_ns)) {
  if (!now_ns_) now_ns_ = [] { return SystemClock().monotonic_ns(); };
}

std::optional<Peer> StrangerBook::announced(const GuidPrefix& prefix, const Peer& peer,
                                            const std::string& address, bool offers_identity) {
  const std::lock_guard lock(mutex_);
  if (const auto found = admitted_.find(prefix); found != admitted_.end()) {
    if (std::exchange(found->second, true)) return std::nullopt;
    return peer;
  }
  if (const auto found = entries_.find(prefix); found != entries_.end()) {
    Entry& known = found->second;
    if (!std::exchange(known.announced, true)) {
      const std::string why = known.stranger.why;
      known.peer = peer;
      known.stranger = to_stranger(prefix, peer, address);
      known.stranger.why = why;
    }
    return std::nullopt;
  }
  if (!make_room()) return std::nullopt;
  Entry& entry = entries_[prefix];
  entry = {peer, to_stranger(prefix, peer, address), now_ns_(), false, true};
  if (!offers_identity) entry.stranger.why = "offers no identity";
  return std::nullopt;
}

bool StrangerBook::make_room() {
  if (entries_.size() < kMost) return true;
  // One that may yet prove itself needs the room more than one that did not.
  const auto refused = std::find_if(entries_.begin(), entries_.end(), [](const auto& known) {
    return known.second.refused || !known.second.stranger.why.empty();
  });
  if (refused == entries_.end()) return false;
  entries_.erase(refused);
  return true;
}

std::vector<Stranger> StrangerBook::forgotten() {
  const std::lock_guard lock(mutex_);
  std::vector<Stranger> out;
  std::erase_if(entries_, [&](const auto& known) {
    const Entry& entry = known.second;
    const bool old = !entry.announced && now_ns_() - entry.since_ns > kMemory;
    if (old) out.push_back(entry.stranger);
    return old;
  });
  return out;
}

std::vector<Stranger> StrangerBook::overdue() {
  const std::lock_guard lock(mutex_);
  std::vector<Stranger> out;
  for (auto& [prefix, entry] : entries_) {
    if (entry.refused || now_ns_() - entry.since_ns < kPatience) continue;
    entry.refused = true;
    entry.stranger.why = "did not prove an identity";
    out.push_back(entry.stranger);
  }
  return out;
}

std::optional<Peer> StrangerBook::admitted(const GuidPrefix& prefix) {
  const std::lock_guard lock(mutex_);
  bool& known = admitted_.try_emplace(prefix, false).first->second;
  const auto found = entries_.find(prefix);
  if (found == entries_.end()) return std::nullopt;
  known = true;
  const Peer peer = found->second.peer;
  entries_.erase(found);
  return peer;
}

Stranger StrangerBook::refused(const GuidPrefix& prefix, const std::string& why) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(prefix);
  if (found == entries_.end()) {
    Entry fresh{{}, to_stranger(prefix, {}, ""), now_ns_(), true, false};
    const bool is_known = admitted_.contains(prefix);
    fresh.stranger.why = is_known ? "is known, and somebody failed to prove the same identity" : why;
    if (!is_known && make_room()) entries_.emplace(prefix, fresh);
    return fresh.stranger;
  }
  Entry& entry = found->second;
  if (!entry.announced) entry.since_ns = now_ns_();
  entry.refused = true;
  if (entry.stranger.why.empty()) entry.stranger.why = why;
  return entry.stranger;
}

std::optional<Stranger> StrangerBook::gone(const GuidPrefix& prefix) {
  const std::lock_guard lock(mutex_);
  admitted_.erase(prefix);
  const auto found = entries_.find(prefix);
  if (found == entries_.end()) return std::nullopt;
  const Entry entry = found->second;
  entries_.erase(found);
  if (!entry.refused) return std::nullopt;
  return entry.stranger;
}

std::vector<Stranger> StrangerBook::present() const {
  const std::lock_guard lock(mutex_);
  std::vector<Stranger> out;
  for (const auto& [prefix, entry] : entries_) {
    if (entry.refused) out.push_back(entry.stranger);
  }
  return out;
}

std::optional<Denial> parse_denial(const std::string& message) {
  struct Opening {
    std::string_view text;
    bool whole;
    bool writes;
  };
  static constexpr Opening kOpenings[] = {{"Error checking create remote writer ", false, true},
                                          {"Error checking create remote reader ", false, false},
                                          {"Error validating remote permissions for ", true, false},
                                          {"Error checking remote participant  ", true, false},
                                          {"Not receive remote permissions of participant ", true, false}};
  for (const Opening& opening : kOpenings) {
    if (!message.starts_with(opening.text)) continue;
    const std::string_view rest = std::string_view(message).substr(opening.text.size());
    Denial denial;
    if (!read_prefix(rest, denial.who)) return std::nullopt;
    denial.whole = opening.whole;
    denial.writes = opening.writes;
    const std::size_t begins = rest.find(" (");
    const std::size_t ends = rest.find(" topic ");
    if (!denial.whole && begins != std::string_view::npos && ends != std::string_view::npos &&
        begins + 2 < ends) {
      denial.topic = cleaned(std::string(rest.substr(begins + 2, ends - begins - 2)));
    }
    return denial;
  }
  return std::nullopt;
}

}  // namespace fathom::bus::detail

namespace fathom::bus {

std::string to_string(const Stranger& stranger) {
  return (stranger.name.empty() ? "one without a name" : "'" + stranger.name + "'") + " (GUID " +
         stranger.guid + (stranger.address.empty() ? "" : ", says it is at " + stranger.address) + ") " +
         stranger.why;
}

}  // namespace fathom::bus

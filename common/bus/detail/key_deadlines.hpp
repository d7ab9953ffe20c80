#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "bus/detail/network/peer_book.hpp"

namespace fathom::bus::detail {

/// Whose sample each key of a topic was last, and whether its deadline is missed. `Handle`: how Fast DDS
/// calls the key. Not thread-safe.
template <class Handle>
class KeyDeadlines {
 public:
  struct Key {
    std::string text;
    WriterGuid writer{};
    bool missed = false;
  };

  /// Notes a sample. `text` gives the key's text where it is not known yet. Returns it where a deadline had
  /// been missed: the fault is over.
  template <class Text>
  std::optional<std::string> heard(const Handle& handle, const WriterGuid& writer, Text&& text) {
    Key& key = keys_[handle];
    if (key.text.empty()) key.text = std::forward<Text>(text)();
    key.writer = writer;
    return std::exchange(key.missed, false) ? std::optional(key.text) : std::nullopt;
  }

  /// Notes a missed deadline. Nothing: the key is unknown, or `owes` says of its writer that it owes nothing.
  template <class Owes>
  std::optional<Key> missed(const Handle& handle, const Owes& owes) {
    const auto found = keys_.find(handle);
    if (found == keys_.end() || !owes(found->second.writer)) return std::nullopt;
    found->second.missed = true;
    return found->second;
  }

  void clear() { keys_.clear(); }

 private:
  std::map<Handle, Key> keys_;
};

}  // namespace fathom::bus::detail

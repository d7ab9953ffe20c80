#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "live/record/difference.hpp"

namespace fathom::cli {

/// Brings together what was recorded and what was computed, whichever comes first. There may be several of a
/// key: of a measurement that was published twice. Memory is bounded: the lowest key makes room.
template <class Key, class Value>
class Ledger {
 public:
  /// What comes of one: nothing yet, equal, or the first difference.
  struct Match {
    bool equal = false;
    std::string difference{};
  };

  explicit Ledger(std::size_t most) : most_(most) {}

  [[nodiscard]] Match computed(const Key& key, const Value& value) {
    const auto waiting = recorded_.find(key);
    if (waiting != recorded_.end()) {
      const Value recorded = waiting->second.front().second;
      waiting->second.pop_front();
      if (waiting->second.empty()) recorded_.erase(waiting);
      return compared(recorded, value);
    }
    computed_[key].push_back(value);
    if (computed_.size() > most_) {
      computed_.erase(computed_.begin());
      ++unheard_;
    }
    return {};
  }

  /// `when`: any number that grows with the recording.
  [[nodiscard]] Match recorded(const Key& key, const Value& value, std::size_t when) {
    const auto now = computed_.find(key);
    if (now != computed_.end()) {
      Match match = compared(value, now->second.front());
      if (match.equal || !take_equal(before_, key, value)) {
        pop(computed_, now);
        return match;
      }
      return {true};
    }
    if (take_equal(before_, key, value)) return {true};
    recorded_[key].emplace_back(when, value);
    if (recorded_.size() > most_) recorded_.erase(recorded_.begin());
    return {};
  }

  /// The engine goes on from another state. What it said before may still be recorded, and of a key that is
  /// said again afterwards either one counts.
  void renew() {
    for (auto& [key, values] : computed_) {
      std::deque<Value>& kept = before_[key];
      kept.insert(kept.end(), values.begin(), values.end());
    }
    computed_.clear();
    while (before_.size() > most_) before_.erase(before_.begin());
  }

  /// Number of those computed whose key is lower, which are not in the recording.
  [[nodiscard]] std::size_t unheard_before(const Key& key) const {
    std::size_t count = unheard_;
    for (auto at = computed_.begin(); at != computed_.end() && at->first < key; ++at) ++count;
    return count;
  }
  /// The first one recorded, and when, for which `condition` holds and nothing was computed.
  template <class Condition>
  [[nodiscard]] std::optional<Value> unfounded(Condition condition) const {
    for (const auto& [key, waiting] : recorded_) {
      for (const auto& [when, value] : waiting) {
        if (condition(value, when)) return value;
      }
    }
    return std::nullopt;
  }

 private:
  using Computed = std::map<Key, std::deque<Value>>;

  static Match compared(const Value& recorded, const Value& computed) {
    const std::string what = first_difference(recorded, computed);
    if (what.empty()) return {true};
    return {false, in_words(recorded) + ": " + what};
  }
  static void pop(Computed& from, typename Computed::iterator at) {
    at->second.pop_front();
    if (at->second.empty()) from.erase(at);
  }
  static bool take_equal(Computed& from, const Key& key, const Value& value) {
    const auto at = from.find(key);
    if (at == from.end() || !first_difference(value, at->second.front()).empty()) return false;
    pop(from, at);
    return true;
  }

  std::size_t most_;
  Computed computed_;  // not yet recorded
  Computed before_;    // likewise, before the engine went on from another state, however often it did
  std::map<Key, std::deque<std::pair<std::size_t, Value>>> recorded_;  // not yet computed
  std::size_t unheard_ = 0;
};

}  // namespace fathom::cli

#pragma once

// Check of a described struct (base/field.hpp) that did not come from a file.

#include <cmath>
#include <functional>
#include <sstream>
#include <type_traits>

#include "base/field.hpp"
#include "base/is_name.hpp"

namespace fathom {

template <class T>
class FieldCheck;

/// The check of T as its description says, made once.
template <class T>
[[nodiscard]] const FieldCheck<T>& field_check() {
  static const FieldCheck<T> kCheck = [] {
    FieldCheck<T> check;
    describe(check);
    return check;
  }();
  return kCheck;
}

namespace detail {

template <class V, class L>
std::optional<Complaint> complaint_of(const V& value, const Rules<L>& rules, const std::string& key) {
  if constexpr (std::is_same_v<V, bool>) {
    return std::nullopt;
  } else if constexpr (std::is_arithmetic_v<V>) {
    const auto number = static_cast<double>(value);
    if (std::isnan(number) && rules.nullable) return std::nullopt;
    // In the member's unit, as a loader computes it: a bound that a file may name passes here as well.
    if (std::isfinite(number) && number >= rules.low * rules.factor && number <= rules.high * rules.factor)
      return std::nullopt;
    std::ostringstream text;
    text << number / rules.factor;
    constexpr bool kWhole = std::is_integral_v<V>;
    return Complaint{key, text.str(),
                     (kWhole ? "a whole number" : "a number") + range_text(rules.low, rules.high, kWhole)};
  } else if constexpr (std::is_enum_v<V>) {
    std::vector<std::string> words;
    for (const auto& [word, meaning] : rules.words) {
      if (meaning == value) return std::nullopt;
      words.push_back(word);
    }
    return Complaint{key, std::to_string(static_cast<long>(value)), "one of " + list_words(words)};
  } else if constexpr (std::is_convertible_v<V, std::string>) {
    // The words of a text are what a file may choose from; code may give a label of its own.
    if (rules.text == TextForm::free || is_name(value)) return std::nullopt;
    if (rules.text == TextForm::optional_name && value.empty()) return std::nullopt;
    return Complaint{key, value, kNameForm};
  } else if constexpr (requires { value.begin(); }) {
    std::size_t index = 0;
    for (const auto& element : value) {
      auto found = complaint_of(element, rules, key + "." + std::to_string(index++));
      if (found) return found;
    }
    return std::nullopt;
  } else {
    return field_check<V>().complaint(value, key + ".");
  }
}

}  // namespace detail

/// A walk over a description that looks at values.
template <class T>
class FieldCheck {
 public:
  template <class M>
  FieldRef<M> field(std::string key, M T::*member, std::string sentence) {
    auto rules = std::make_shared<Rules<Leaf<M>>>();
    auto row = std::make_unique<Row>();
    row->info = {std::move(key), std::move(sentence)};
    row->complaint = [rules, member](const T& whole, const std::string& at) {
      return detail::complaint_of(whole.*member, *rules, at);
    };
    if constexpr (std::is_enum_v<M>) {
      row->word = [rules, member](const T& whole) -> std::string {
        for (const auto& [word, meaning] : rules->words) {
          if (meaning == whole.*member) return word;
        }
        return {};
      };
    }
    rows_.push_back(std::move(row));
    return {rows_.back()->info, std::move(rules)};
  }

  /// The first value that is not as described. `prefix` goes before the key.
  [[nodiscard]] std::optional<Complaint> complaint(const T& whole, const std::string& prefix = "") const {
    std::string choice;
    for (const auto& row : rows_) {
      if (row->info.decides() && row->word) choice = row->word(whole);
    }
    for (const auto& row : rows_) {
      if (!choice.empty() && !row->info.known_to(choice)) continue;
      auto found = row->complaint(whole, prefix + row->info.key);
      if (found) return found;
    }
    return std::nullopt;
  }

 private:
  struct Row {
    FieldInfo info;
    std::function<std::optional<Complaint>(const T&, const std::string&)> complaint;
    std::function<std::string(const T&)> word;
  };
  std::vector<std::unique_ptr<Row>> rows_;  // FieldRef keeps references to their info
};

}  // namespace fathom

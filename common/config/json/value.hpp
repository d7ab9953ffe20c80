#pragma once

// Conversion of single values between JSON and C++ for config/json/schema.hpp; not included by anything else.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/field.hpp"
#include "base/name.hpp"
#include "config/json/error.hpp"

namespace fathom::config {

/// As much of a value as an error shows.
[[nodiscard]] std::string shorten(std::string text);

/// Where in which file a value stands.
struct Place {
  std::string file;
  std::string key;  ///< dotted path, empty at the top

  [[nodiscard]] Place child(const std::string& name) const {
    return {file, key.empty() ? name : key + "." + name};
  }
  [[noreturn]] void fail(const nlohmann::json& value, const std::string& expectation) const;
  /// Likewise where the value is text already.
  [[noreturn]] void fail_text(const std::string& value, const std::string& expectation) const;
  [[noreturn]] void fail_missing(const std::string& sentence) const;
};

/// The base of a request, its file and its overrides as one; who said what stands in `layers`.
struct Document {
  nlohmann::json value;
  std::string file;
  std::shared_ptr<const Layers> layers;

  /// The same error about the file and the key that the value came from.
  [[noreturn]] void fail(const ConfigError& error) const;
};
/// Throws ConfigError.
[[nodiscard]] Document read_document(const LoadRequest& request);

template <class M>
inline constexpr bool is_number = std::is_arithmetic_v<M> && !std::is_same_v<M, bool>;
template <class M>
inline constexpr bool is_text = std::is_same_v<M, std::string> || std::is_same_v<M, Name>;
template <class M>
inline constexpr bool is_described = std::is_class_v<M> && !is_text<M> && std::is_same_v<M, Leaf<M>>;

// What does not depend on the type, compiled once.
/// The number, checked; NaN for null where that is allowed.
[[nodiscard]] double load_real(const nlohmann::json& json, double low, double high, bool nullable,
                               const Place& place);
void check_integer(const nlohmann::json& json, double low, double high, const Place& place);
[[nodiscard]] std::string load_text(const nlohmann::json& json, const std::vector<std::string>& words,
                                    TextForm form, const Place& place);
/// Position of the word in `words`.
[[nodiscard]] std::size_t load_word(const nlohmann::json& json, const std::vector<std::string>& words,
                                    const Place& place);
[[nodiscard]] nlohmann::json dump_real(double value, double factor);
[[nodiscard]] nlohmann::json boolean_schema();
[[nodiscard]] nlohmann::json number_schema(bool integer, bool nullable, double low, double high);
[[nodiscard]] nlohmann::json words_schema(const std::vector<std::string>& words);
[[nodiscard]] nlohmann::json text_schema(const std::vector<std::string>& words, TextForm form);
[[nodiscard]] nlohmann::json optional_schema(nlohmann::json element);
[[nodiscard]] nlohmann::json map_schema(nlohmann::json element);
[[nodiscard]] nlohmann::json array_schema(nlohmann::json element, std::size_t size);

template <class L>
[[nodiscard]] std::vector<std::string> word_list(const Rules<L>& rules) {
  std::vector<std::string> out;
  for (const auto& [word, value] : rules.words) out.push_back(word);
  return out;
}

template <class M, class L>
[[nodiscard]] TextForm text_form(const Rules<L>& rules) {
  return std::is_same_v<M, Name> && rules.text == TextForm::free ? TextForm::optional_name : rules.text;
}

/// What a single value may be, for people; empty where anything will do.
template <class L>
[[nodiscard]] std::string range_of(const Rules<L>& rules) {
  if constexpr (std::is_same_v<L, bool>) return "true or false";
  const std::vector<std::string> words = word_list(rules);
  if (!words.empty()) return list_words(words);
  if constexpr (is_number<L>) {
    const std::string text = range_text(rules.low, rules.high, !std::is_floating_point_v<L>);
    const std::string_view from = " from ";
    return text.substr(std::min(text.size(), text.starts_with(from) ? from.size() : 1)) +
           (rules.nullable ? ", null" : "");
  } else if constexpr (is_text<L>) {
    return text_form<L>(rules) == TextForm::free ? "text" : "name";
  } else {
    return "";
  }
}

inline void load_value(const nlohmann::json& json, bool& out, const Rules<bool>&, const Place& place) {
  if (!json.is_boolean()) place.fail(json, "true or false");
  out = json.get<bool>();
}

template <class M>
requires is_number<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>& rules, const Place& place) {
  if constexpr (std::is_floating_point_v<M>) {
    out = load_real(json, rules.low, rules.high, rules.nullable, place) * rules.factor;
  } else {
    check_integer(json, std::max(rules.low, static_cast<double>(std::numeric_limits<M>::lowest())),
                  std::min(rules.high, static_cast<double>(std::numeric_limits<M>::max())), place);
    out = json.get<M>();
  }
}

template <class M>
requires is_text<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>& rules, const Place& place) {
  out = M(load_text(json, word_list(rules), text_form<M>(rules), place));
}

template <class M>
requires std::is_enum_v<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>& rules, const Place& place) {
  out = rules.words[load_word(json, word_list(rules), place)].second;
}

template <class M>
requires is_described<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>& rules, const Place& place);
template <class M>
requires is_described<M> nlohmann::json dump_value(const M& value, const Rules<M>& rules);
template <class M>
requires is_described<M> nlohmann::json described_schema();

// Containers first declare, so that they may nest in any order.
template <class U, class L>
void load_value(const nlohmann::json& json, std::vector<U>& out, const Rules<L>& rules, const Place& place);
template <class U, std::size_t N, class L>
void load_value(const nlohmann::json& json, std::array<U, N>& out, const Rules<L>& rules, const Place& place);
template <class U, class L>
void load_value(const nlohmann::json& json, std::optional<U>& out, const Rules<L>& rules, const Place& place);
template <class U, class L>
void load_value(const nlohmann::json& json, std::map<std::string, U>& out, const Rules<L>& rules,
                const Place& place);

template <class U, class L>
void load_value(const nlohmann::json& json, std::vector<U>& out, const Rules<L>& rules, const Place& place) {
  if (!json.is_array()) place.fail(json, "an array");
  out.clear();
  Mistakes mistakes;
  for (std::size_t i = 0; i < json.size(); ++i) {
    U element{};
    mistakes.in([&] { load_value(json[i], element, rules, place.child(std::to_string(i))); });
    out.push_back(std::move(element));
  }
  mistakes.raise();
}

template <class U, std::size_t N, class L>
void load_value(const nlohmann::json& json, std::array<U, N>& out, const Rules<L>& rules,
                const Place& place) {
  if (!json.is_array() || json.size() != N) place.fail(json, "an array of " + std::to_string(N));
  Mistakes mistakes;
  for (std::size_t i = 0; i < N; ++i)
    mistakes.in([&] { load_value(json[i], out[i], rules, place.child(std::to_string(i))); });
  mistakes.raise();
}

template <class U, class L>
void load_value(const nlohmann::json& json, std::optional<U>& out, const Rules<L>& rules,
                const Place& place) {
  if (json.is_null()) {
    out.reset();
    return;
  }
  U value = out.value_or(U{});
  load_value(json, value, rules, place);
  out = std::move(value);
}

template <class U, class L>
void load_value(const nlohmann::json& json, std::map<std::string, U>& out, const Rules<L>& rules,
                const Place& place) {
  if (!json.is_object()) place.fail(json, "an object");
  out.clear();
  Mistakes mistakes;
  for (const auto& item : json.items())
    mistakes.in([&] { load_value(item.value(), out[item.key()], rules, place.child(item.key())); });
  mistakes.raise();
}

template <class M>
nlohmann::json dump_value(const M& value, const Rules<Leaf<M>>& rules) requires(!is_described<M>) {
  if constexpr (std::is_same_v<M, bool>) {
    return value;
  } else if constexpr (std::is_floating_point_v<M>) {
    return dump_real(value, rules.factor);
  } else if constexpr (is_number<M>) {
    return value;
  } else if constexpr (std::is_same_v<M, Name>) {
    return value.str();
  } else if constexpr (std::is_same_v<M, std::string>) {
    return value;
  } else if constexpr (std::is_enum_v<M>) {
    for (const auto& [word, meaning] : rules.words) {
      if (meaning == value) return word;
    }
    return nullptr;
  } else if constexpr (requires { value.has_value(); }) {
    return value.has_value() ? dump_value(*value, rules) : nlohmann::json(nullptr);
  } else if constexpr (requires { value.begin()->second; }) {
    nlohmann::json out = nlohmann::json::object();
    for (const auto& [key, element] : value) out[key] = dump_value(element, rules);
    return out;
  } else {
    nlohmann::json out = nlohmann::json::array();
    for (const auto& element : value) out.push_back(dump_value(element, rules));
    return out;
  }
}

template <class M>
struct ElementOf;
template <class U>
struct ElementOf<std::vector<U>> {
  using type = U;
};
template <class U, std::size_t N>
struct ElementOf<std::array<U, N>> {
  using type = U;
};
template <class U>
struct ElementOf<std::optional<U>> {
  using type = U;
};
template <class U>
struct ElementOf<std::map<std::string, U>> {
  using type = U;
};

template <class M>
nlohmann::json value_schema(const Rules<Leaf<M>>& rules) {
  if constexpr (is_described<M>) {
    return described_schema<M>();
  } else if constexpr (std::is_same_v<M, bool>) {
    return boolean_schema();
  } else if constexpr (is_number<M>) {
    return number_schema(!std::is_floating_point_v<M>, rules.nullable, rules.low, rules.high);
  } else if constexpr (std::is_enum_v<M>) {
    return words_schema(word_list(rules));
  } else if constexpr (is_text<M>) {
    return text_schema(word_list(rules), text_form<M>(rules));
  } else {
    nlohmann::json element = value_schema<typename ElementOf<M>::type>(rules);
    if constexpr (requires(M m) { m.has_value(); }) {
      return optional_schema(std::move(element));
    } else if constexpr (requires(M m) { m.begin()->second; }) {
      return map_schema(std::move(element));
    } else if constexpr (requires { std::tuple_size<M>::value; }) {
      return array_schema(std::move(element), std::tuple_size<M>::value);
    } else {
      return array_schema(std::move(element), 0);
    }
  }
}

}  // namespace fathom::config

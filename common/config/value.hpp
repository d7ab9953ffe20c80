#pragma once

// Conversion of single values between JSON and C++ for config/schema.hpp; not included by anything else.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/name.hpp"
#include "config/error.hpp"

namespace fathom::config {

/// Where in which file a value stands.
struct Place {
  std::string file;
  std::string key;  ///< dotted path, empty at the top

  [[nodiscard]] Place child(const std::string& name) const {
    return {file, key.empty() ? name : key + "." + name};
  }
  [[noreturn]] void fail(const nlohmann::json& value, const std::string& expectation) const;
  [[noreturn]] void fail_missing(const std::string& description) const;
};

struct FieldInfo {
  std::string key;
  std::string description;
  std::string unit;
  bool required = false;
};

template <class L>
struct Rules {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double factor = 1.0;
  bool nullable = false;
  std::vector<std::pair<std::string, L>> words;
};

// What a container is made of in the end: the type that rules apply to.
template <class M>
struct LeafOf {
  using type = M;
};
template <class U>
struct LeafOf<std::vector<U>> : LeafOf<U> {};
template <class U, std::size_t N>
struct LeafOf<std::array<U, N>> : LeafOf<U> {};
template <class U>
struct LeafOf<std::optional<U>> : LeafOf<U> {};
template <class U>
struct LeafOf<std::map<std::string, U>> : LeafOf<U> {};
template <class M>
using Leaf = typename LeafOf<M>::type;

template <class M>
inline constexpr bool is_number = std::is_arithmetic_v<M> && !std::is_same_v<M, bool>;
template <class M>
inline constexpr bool is_text = std::is_same_v<M, std::string> || std::is_same_v<M, Name>;
template <class M>
inline constexpr bool is_described = std::is_class_v<M> && !is_text<M> && std::is_same_v<M, Leaf<M>>;

[[nodiscard]] nlohmann::json read_json(const LoadRequest& request);
[[nodiscard]] std::string list_words(const std::vector<std::string>& words);
[[nodiscard]] std::string describe_range(double low, double high, bool integer);

template <class L>
[[nodiscard]] std::vector<std::string> word_list(const Rules<L>& rules) {
  std::vector<std::string> out;
  for (const auto& [word, value] : rules.words) out.push_back(word);
  return out;
}

inline void load_value(const nlohmann::json& json, bool& out, const Rules<bool>&, const Place& place) {
  if (!json.is_boolean()) place.fail(json, "true or false");
  out = json.get<bool>();
}

template <class M>
requires is_number<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>& rules, const Place& place) {
  if constexpr (std::is_floating_point_v<M>) {
    if (rules.nullable && json.is_null()) {
      out = std::numeric_limits<M>::quiet_NaN();
      return;
    }
    if (!json.is_number()) place.fail(json, "a number" + describe_range(rules.low, rules.high, false));
    const double value = json.get<double>();
    if (!std::isfinite(value) || value < rules.low || value > rules.high) {
      place.fail(json, "a number" + describe_range(rules.low, rules.high, false));
    }
    out = value * rules.factor;
  } else {
    const double low = std::max(rules.low, static_cast<double>(std::numeric_limits<M>::lowest()));
    const double high = std::min(rules.high, static_cast<double>(std::numeric_limits<M>::max()));
    if (!json.is_number_integer() || json.get<double>() < low || json.get<double>() > high) {
      place.fail(json, "a whole number" + describe_range(low, high, true));
    }
    out = json.get<M>();
  }
}

template <class M>
requires is_text<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>& rules, const Place& place) {
  if (!json.is_string()) place.fail(json, "a string");
  const auto text = json.get<std::string>();
  if constexpr (std::is_same_v<M, Name>) {
    if (text.size() > Name::kCapacity) {
      place.fail(json, "at most " + std::to_string(Name::kCapacity) + " characters");
    }
  }
  if (!rules.words.empty()) {
    bool found = false;
    for (const auto& entry : rules.words) found = found || entry.first == text;
    if (!found) place.fail(json, "one of " + list_words(word_list(rules)));
  }
  out = M(text);
}

template <class M>
requires std::is_enum_v<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>& rules, const Place& place) {
  if (json.is_string()) {
    for (const auto& [word, value] : rules.words) {
      if (word == json.get<std::string>()) {
        out = value;
        return;
      }
    }
  }
  place.fail(json, "one of " + list_words(word_list(rules)));
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
  for (std::size_t i = 0; i < json.size(); ++i) {
    U element{};
    load_value(json[i], element, rules, place.child(std::to_string(i)));
    out.push_back(std::move(element));
  }
}

template <class U, std::size_t N, class L>
void load_value(const nlohmann::json& json, std::array<U, N>& out, const Rules<L>& rules,
                const Place& place) {
  if (!json.is_array() || json.size() != N) place.fail(json, "an array of " + std::to_string(N));
  for (std::size_t i = 0; i < N; ++i) load_value(json[i], out[i], rules, place.child(std::to_string(i)));
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
  for (const auto& [key, value] : json.items()) load_value(value, out[key], rules, place.child(key));
}

template <class M>
nlohmann::json dump_value(const M& value, const Rules<Leaf<M>>& rules) requires(!is_described<M>) {
  if constexpr (std::is_same_v<M, bool>) {
    return value;
  } else if constexpr (std::is_floating_point_v<M>) {
    return std::isfinite(value) ? nlohmann::json(value / rules.factor) : nlohmann::json(nullptr);
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
    return {{"type", "boolean"}};
  } else if constexpr (is_number<M>) {
    nlohmann::json out = {{"type", std::is_floating_point_v<M> ? "number" : "integer"}};
    if (rules.nullable) out["type"] = nlohmann::json::array({"number", "null"});
    if (std::isfinite(rules.low)) out["minimum"] = rules.low;
    if (std::isfinite(rules.high)) out["maximum"] = rules.high;
    return out;
  } else if constexpr (std::is_enum_v<M>) {
    return {{"enum", word_list(rules)}};
  } else if constexpr (is_text<M>) {
    nlohmann::json out = {{"type", "string"}};
    if constexpr (std::is_same_v<M, Name>) out["maxLength"] = Name::kCapacity;
    if (!rules.words.empty()) out["enum"] = word_list(rules);
    return out;
  } else {
    nlohmann::json element = value_schema<typename ElementOf<M>::type>(rules);
    if constexpr (requires(M m) { m.has_value(); }) {
      return {{"anyOf", nlohmann::json::array({element, {{"type", "null"}}})}};
    } else if constexpr (requires(M m) { m.begin()->second; }) {
      return {{"type", "object"}, {"additionalProperties", element}};
    } else {
      nlohmann::json out = {{"type", "array"}, {"items", element}};
      if constexpr (requires { std::tuple_size<M>::value; }) {
        out["minItems"] = std::tuple_size<M>::value;
        out["maxItems"] = std::tuple_size<M>::value;
      }
      return out;
    }
  }
}

}  // namespace fathom::config

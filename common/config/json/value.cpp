#include "config/json/value.hpp"

#include <algorithm>
#include <limits>

#include "base/is_name.hpp"
#include "config/json/strict_json.hpp"

namespace fathom::config {

std::string shorten(std::string text) {
  constexpr std::size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost - 3) + "...";
  return text;
}

void Place::fail(const nlohmann::json& value, const std::string& expectation) const {
  fail_text(shorten(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)), expectation);
}

void Place::fail_text(const std::string& value, const std::string& expectation) const {
  throw ConfigError(file, key.empty() ? "(whole file)" : key, value, expectation);
}

void Place::fail_missing(const std::string& sentence) const {
  throw ConfigError(file, key, "missing", sentence);
}

double load_real(const nlohmann::json& json, double low, double high, bool nullable, const Place& place) {
  if (nullable && json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  const double value = json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(value) || value < low || value > high) {
    place.fail(json, "a number" + range_text(low, high, false));
  }
  return value;
}

void check_integer(const nlohmann::json& json, double low, double high, const Place& place) {
  if (!json.is_number_integer() || json.get<double>() < low || json.get<double>() > high) {
    place.fail(json, "a whole number" + range_text(low, high, true));
  }
}

std::string load_text(const nlohmann::json& json, const std::vector<std::string>& words, TextForm form,
                      const Place& place) {
  if (!words.empty()) return words[load_word(json, words, place)];
  if (!json.is_string()) place.fail(json, "a string");
  auto text = json.get<std::string>();
  if (form == TextForm::free) {
    if (one_line(text) != text) place.fail(json, "a text without control characters");
  } else if (!is_name(text) && (form == TextForm::name || !text.empty())) {
    place.fail(json, std::string(form == TextForm::name ? "" : "nothing or ") + kNameForm);
  }
  return text;
}

std::size_t load_word(const nlohmann::json& json, const std::vector<std::string>& words, const Place& place) {
  const auto at =
      json.is_string() ? std::find(words.begin(), words.end(), json.get<std::string>()) : words.end();
  if (at == words.end()) place.fail(json, "one of " + list_words(words));
  return static_cast<std::size_t>(at - words.begin());
}

nlohmann::json dump_real(double value, double factor) {
  return std::isfinite(value) ? nlohmann::json(value / factor) : nlohmann::json(nullptr);
}

nlohmann::json boolean_schema() {
  return {{"type", "boolean"}};
}

nlohmann::json number_schema(bool integer, bool nullable, double low, double high) {
  nlohmann::json out = {{"type", integer ? "integer" : "number"}};
  if (nullable) out["type"] = nlohmann::json::array({"number", "null"});
  if (std::isfinite(low)) out["minimum"] = low;
  if (std::isfinite(high)) out["maximum"] = high;
  return out;
}

nlohmann::json words_schema(const std::vector<std::string>& words) {
  return {{"enum", words}};
}

nlohmann::json text_schema(const std::vector<std::string>& words, TextForm form) {
  nlohmann::json out = {{"type", "string"}};
  if (form != TextForm::free) {
    const std::string name = "[A-Za-z0-9_-][A-Za-z0-9_.-]{0,30}";
    out["pattern"] = form == TextForm::name ? "^" + name + "$" : "^(" + name + ")?$";
  }
  if (!words.empty()) out["enum"] = words;
  return out;
}

nlohmann::json optional_schema(nlohmann::json element) {
  return {{"anyOf", nlohmann::json::array({std::move(element), {{"type", "null"}}})}};
}

nlohmann::json map_schema(nlohmann::json element) {
  return {{"type", "object"}, {"additionalProperties", std::move(element)}};
}

nlohmann::json array_schema(nlohmann::json element, std::size_t size) {
  nlohmann::json out = {{"type", "array"}, {"items", std::move(element)}};
  if (size > 0) {
    out["minItems"] = size;
    out["maxItems"] = size;
  }
  return out;
}

}  // namespace fathom::config

#include "config/value.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <sstream>

namespace fathom::config {
namespace {

std::string shorten(std::string text) {
  constexpr std::size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost - 3) + "...";
  return text;
}

std::string number_text(double value, bool integer) {
  std::array<char, 32> text{};
  const auto result =
      integer && std::abs(value) < 9e15
          ? std::to_chars(text.data(), text.data() + text.size(), static_cast<std::int64_t>(value))
          : std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), result.ptr};
}

// Follows `path` ("a.b.0.c") and returns the node there, creating objects on the way.
nlohmann::json& node_at(nlohmann::json& root, const std::string& path, const LoadRequest& request,
                        const std::string& value) {
  nlohmann::json* node = &root;
  std::istringstream parts(path);
  std::string part;
  while (std::getline(parts, part, '.')) {
    if (node->is_array()) {
      std::size_t index = 0;
      const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
      if (error != std::errc() || end != part.data() + part.size() || index >= node->size()) {
        throw ConfigError(request.file, path, value,
                          "an index below " + std::to_string(node->size()) + " where the key says " + part);
      }
      node = &(*node)[index];
    } else if (node->is_object() || node->is_null()) {
      node = &(*node)[part];
    } else {
      throw ConfigError(request.file, path, value,
                        "a key that exists; the part before " + part + " is a single value");
    }
  }
  return *node;
}

}  // namespace

ConfigError::ConfigError(const std::string& file, const std::string& key, const std::string& value,
                         const std::string& expectation)
    : std::runtime_error(file + ": " + key + ": is " + value + ", expected " + expectation) {}

ConfigError::ConfigError(const std::string& file, const std::string& problem)
    : std::runtime_error(file + ": " + problem) {}

void Place::fail(const nlohmann::json& value, const std::string& expectation) const {
  const std::string text = shorten(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  throw ConfigError(file, key.empty() ? "(whole file)" : key, text, expectation);
}

void Place::fail_missing(const std::string& description) const {
  throw ConfigError(file, key, "missing", description);
}

nlohmann::json read_json(const LoadRequest& request) {
  std::ifstream in(request.file, std::ios::binary);
  if (!in) throw ConfigError(request.file, "cannot be read, expected a JSON configuration file");
  std::ostringstream buffer;
  buffer << in.rdbuf();
  const std::string text = buffer.str();
  nlohmann::json json;
  try {
    json = nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    const std::size_t byte = std::min(error.byte > 0 ? error.byte - 1 : 0, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(byte), '\n');
    std::string what = error.what();
    if (const auto colon = what.find("syntax error"); colon != std::string::npos) what = what.substr(colon);
    throw ConfigError(request.file + ":" + std::to_string(line), "is not JSON: " + what);
  }
  for (const std::string& set : request.sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(request.file, "--set " + set + ": expected key.sub=value");
    }
    const std::string path = set.substr(0, equals);
    const std::string value = set.substr(equals + 1);
    // What reads as JSON is taken as JSON; the rest is text, so that --set source.path=/dev/ttyS0 needs no
    // quotes.
    nlohmann::json parsed = nlohmann::json::parse(value, nullptr, false);
    node_at(json, path, request, value) = parsed.is_discarded() ? nlohmann::json(value) : parsed;
  }
  return json;
}

std::string list_words(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

std::string describe_range(double low, double high, bool integer) {
  const bool has_low = std::isfinite(low);
  const bool has_high = std::isfinite(high);
  if (has_low && has_high) return " from " + number_text(low, integer) + " to " + number_text(high, integer);
  if (has_low) return " of at least " + number_text(low, integer);
  if (has_high) return " of at most " + number_text(high, integer);
  return "";
}

double load_real(const nlohmann::json& json, double low, double high, bool nullable, const Place& place) {
  if (nullable && json.is_null()) return std::numeric_limits<double>::quiet_NaN();
  const double value = json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(value) || value < low || value > high) {
    place.fail(json, "a number" + describe_range(low, high, false));
  }
  return value;
}

void check_integer(const nlohmann::json& json, double low, double high, const Place& place) {
  if (!json.is_number_integer() || json.get<double>() < low || json.get<double>() > high) {
    place.fail(json, "a whole number" + describe_range(low, high, true));
  }
}

std::string load_text(const nlohmann::json& json, const std::vector<std::string>& words, std::size_t most,
                      const Place& place) {
  if (!words.empty()) return words[load_word(json, words, place)];
  if (!json.is_string()) place.fail(json, "a string");
  auto text = json.get<std::string>();
  if (most > 0 && text.size() > most) place.fail(json, "at most " + std::to_string(most) + " characters");
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

nlohmann::json text_schema(const std::vector<std::string>& words, std::size_t most) {
  nlohmann::json out = {{"type", "string"}};
  if (most > 0) out["maxLength"] = most;
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

#include "config/json/value.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>
#include <sstream>

#include <sys/stat.h>

#include "base/is_name.hpp"
#include "config/json/strict_json.hpp"

namespace fathom::config {
namespace {

constexpr std::size_t kMostBytes = 4UL << 20;

std::string shorten(std::string text) {
  constexpr std::size_t kMost = 60;
  if (text.size() > kMost) text = text.substr(0, kMost - 3) + "...";
  return text;
}

/// The whole of a configuration file. A device would be read without end and a pipe waits for a writer, so
/// that only a regular file is opened.
std::string read_text(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0)
    throw ConfigError(file, "cannot be read, expected a JSON configuration file");
  if (!S_ISREG(status.st_mode)) {
    const char* kind = S_ISDIR(status.st_mode)                              ? "a folder"
                       : S_ISFIFO(status.st_mode)                           ? "a pipe"
                       : S_ISCHR(status.st_mode) || S_ISBLK(status.st_mode) ? "a device"
                                                                            : "a socket";
    throw ConfigError(file, std::string("is ") + kind + ", expected a regular file");
  }
  std::ifstream in(file, std::ios::binary);
  if (!in) throw ConfigError(file, "cannot be read, expected a JSON configuration file");
  std::string text(kMostBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) throw ConfigError(file, "cannot be read, expected a JSON configuration file");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMostBytes) throw ConfigError(file, "is larger, expected at most 4 MiB");
  return text;
}

// Text in an override needs no quotes: what is not JSON is text, and so is a number that no double holds.
bool reads_as_text(const JsonFault& fault) {
  return fault.kind == JsonFault::Kind::syntax ||
         (fault.kind == JsonFault::Kind::number && fault.key.empty());
}

// The place in an array that a part of a key names: by its index, or by the name of the sensor there.
std::size_t index_of(const nlohmann::json& array, const std::string& part) {
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  if (error == std::errc() && end == part.data() + part.size()) return index;
  const auto named = std::find_if(array.begin(), array.end(), [&part](const nlohmann::json& one) {
    return one.is_object() && one.contains("sensor") && one["sensor"] == part;
  });
  return static_cast<std::size_t>(named - array.begin());
}

// Follows `path` ("a.b.0.c") and returns the node there, creating objects on the way.
nlohmann::json& node_at(nlohmann::json& root, const std::string& path, const LoadRequest& request,
                        const std::string& value) {
  nlohmann::json* node = &root;
  if (static_cast<std::size_t>(std::count(path.begin(), path.end(), '.')) >= kJsonLevels) {
    throw ConfigError(request.file, shorten(path), "nested deeper",
                      "at most " + std::to_string(kJsonLevels) + " levels");
  }
  std::istringstream parts(path);
  std::string part;
  while (std::getline(parts, part, '.')) {
    if (node->is_array()) {
      const std::size_t index = index_of(*node, part);
      if (index >= node->size()) {
        throw ConfigError(request.file, path, shorten(value),
                          "an index below " + std::to_string(node->size()) +
                              ", or the name of a sensor that stands there, where the key says " + part);
      }
      node = &(*node)[index];
    } else if (node->is_object() || node->is_null()) {
      node = &(*node)[part];
    } else {
      throw ConfigError(request.file, path, shorten(value),
                        "a key that exists; the part before " + part + " is a single value");
    }
  }
  return *node;
}

}  // namespace

ConfigError::ConfigError(const std::string& file, const std::string& key, const std::string& value,
                         const std::string& expectation)
    : std::runtime_error(one_line(file + ": " + key + ": is " + value + ", expected " + expectation)) {}

ConfigError::ConfigError(const std::string& file, const std::string& problem)
    : std::runtime_error(one_line(file + ": " + problem)) {}

void Place::fail(const nlohmann::json& value, const std::string& expectation) const {
  fail_text(shorten(value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)), expectation);
}

void Place::fail_text(const std::string& value, const std::string& expectation) const {
  throw ConfigError(file, key.empty() ? "(whole file)" : key, value, expectation);
}

void Place::fail_missing(const std::string& sentence) const {
  throw ConfigError(file, key, "missing", sentence);
}

nlohmann::json read_json(const LoadRequest& request) {
  StrictJson json = parse_strict(read_text(request.file));
  if (json.fault) {
    const JsonFault& fault = *json.fault;
    if (fault.kind == JsonFault::Kind::syntax)
      throw ConfigError(request.file + ":" + std::to_string(fault.line), "is not JSON: " + fault.is);
    throw ConfigError(request.file, describe(fault));
  }
  for (const std::string& set : request.sets) {
    const auto equals = set.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw ConfigError(request.file, "--set " + shorten(set) + ": expected key.sub=value");
    }
    const std::string path = set.substr(0, equals);
    const std::string value = set.substr(equals + 1);
    // What reads as JSON is taken as JSON; the rest is text, so that --set source.path=/dev/ttyS0 needs no
    // quotes.
    StrictJson parsed = parse_strict(value);
    if (parsed.fault && !reads_as_text(*parsed.fault)) {
      parsed.fault->key = path + "." + parsed.fault->key;
      throw ConfigError(request.file, describe(*parsed.fault));
    }
    node_at(json.value, path, request, value) =
        parsed.fault ? nlohmann::json(value) : std::move(parsed.value);
  }
  return std::move(json.value);
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

#include "config/json/layers.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "base/disk/regular_file.hpp"
#include "config/json/strict_json.hpp"
#include "config/json/value.hpp"

namespace fathom::config {
namespace {

constexpr std::size_t kMostBytes = 4UL << 20;

/// The whole of a configuration file.
std::string read_text(const std::string& file) {
  auto text = read_regular_file(file, kMostBytes);
  if (!text) throw ConfigError(file, text.error().message);
  return std::move(text.value());
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

using nlohmann::json;

std::string joined(const std::string& key, const std::string& part) {
  return key.empty() ? part : key + "." + part;
}

/// The key without its last part.
std::string around(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? "" : key.substr(0, dot);
}

/// The name by which an element of an array is known; empty where it has none.
std::string name_of(const json& element) {
  if (!element.is_object()) return "";
  for (const char* key : {"name", "sensor"}) {
    if (const auto at = element.find(key); at != element.end() && at->is_string()) return *at;
  }
  return "";
}

/// Two elements of the same name are of one kind as well where both say theirs: a propulsor and the fins of
/// one bridge share a name.
bool same(const json& one, const json& other) {
  if (name_of(one) != name_of(other)) return false;
  const auto kind = one.find("kind");
  const auto other_kind = other.find("kind");
  return kind == one.end() || other_kind == other.end() || *kind == *other_kind;
}

bool all_named(const json& array) {
  return std::all_of(array.begin(), array.end(), [](const json& one) { return !name_of(one).empty(); });
}

}  // namespace

std::string_view to_string(Layer layer) {
  switch (layer) {
    case Layer::catalogue:
      return "catalogue";
    case Layer::vehicle:
      return "vehicle";
    case Layer::override_:
      return "override";
    case Layer::command_line:
      return "command line";
    case Layer::standard:
      break;
  }
  return "default";
}

void Layers::remember(const json& node, const std::string& key, const Origin& origin) {
  if (node.is_structured() && !node.empty()) {
    for (const auto& [part, child] : node.items()) remember(child, joined(key, part), origin.child(part));
  } else {
    origins_[key] = origin;
  }
}

void Layers::replace(json& into, const std::string& key, json document, const Origin& origin) {
  const std::string below = key + ".";
  origins_.erase(key);
  origins_.erase(origins_.lower_bound(below), origins_.lower_bound(key + "/"));  // '/' is next to '.'
  into = std::move(document);
  remember(into, key, origin);
}

void Layers::merge(json& into, const std::string& key, const json& document, const Origin& origin) {
  if (document.is_object() && into.is_object()) {
    for (const auto& [part, child] : document.items()) {
      if (part != "$comment" && part != "$schema")
        merge(into[part], joined(key, part), child, origin.child(part));
    }
  } else if (document.is_array() && into.is_array() && !into.empty() && !document.empty() &&
             all_named(document) && all_named(into)) {
    for (std::size_t i = 0; i < document.size(); ++i) {
      std::size_t at = 0;
      while (at < into.size() && !same(into[at], document[i])) ++at;
      if (at == into.size()) into.push_back(nullptr);
      merge(into[at], joined(key, std::to_string(at)), document[i], origin.child(std::to_string(i)));
    }
  } else {
    replace(into, key, document, origin);
  }
}

void Layers::overlay(const std::string& key, const json& document, const Origin& origin) {
  std::string resolved;
  merge(key.empty() ? value_ : node_at(key, "", resolved), key, document, origin);
}

void Layers::grow(const std::string& key) {
  std::string resolved;
  node_at(key, "", resolved).push_back(json::object());
}

Origin Layers::origin_of(const std::string& key) const {
  if (const auto at = origins_.find(key); at != origins_.end()) return at->second;
  Origin out;
  for (auto at = origins_.lower_bound(key + "."); at != origins_.end() && at->first.starts_with(key + ".");
       ++at) {
    if (at->second.layer < out.layer || (at->second.layer == out.layer && !out.file.empty())) continue;
    out = at->second;
    const std::size_t depth = static_cast<std::size_t>(
        std::count(at->first.begin() + static_cast<std::ptrdiff_t>(key.size()), at->first.end(), '.'));
    for (std::size_t i = 0; i < depth; ++i) out.key = around(out.key);
  }
  return out;
}

Origin Layers::place_of(const std::string& key) const {
  if (const auto at = origins_.find(key); at != origins_.end()) return at->second;
  if (const auto at = origins_.find(key + ".0"); at != origins_.end()) {
    Origin out = at->second;
    out.key = around(out.key);
    return out;
  }
  for (std::string near = key;; near = around(near)) {
    if (const auto at = marks_.find(near); at != marks_.end()) {
      Origin out = at->second;
      if (near.size() < key.size()) out.key = joined(out.key, key.substr(near.empty() ? 0 : near.size() + 1));
      return out;
    }
    if (near.empty()) return {};
  }
}

void Layers::fail(const ConfigError& error) const {
  Mistakes mistakes;
  for (const ConfigError& one : error.each()) {
    const bool mine = !one.key().empty() && one.file() == file_;
    const Origin origin = mine ? place_of(one.key()) : Origin{};
    mistakes.add(origin.file.empty() ? one
                                     : ConfigError(origin.file, origin.key, one.value(), one.expectation()));
  }
  mistakes.raise();
  throw ConfigError(error);
}

// Follows `path` ("a.b.0.c") and returns the node there, creating objects on the way. `resolved` becomes the
// same path with indices.
json& Layers::node_at(const std::string& path, const std::string& value, std::string& resolved) {
  json* node = &value_;
  if (static_cast<std::size_t>(std::count(path.begin(), path.end(), '.')) >= kJsonLevels) {
    throw ConfigError(file_, shorten(path), "nested deeper",
                      "at most " + std::to_string(kJsonLevels) + " levels");
  }
  std::istringstream parts(path);
  std::string part;
  while (std::getline(parts, part, '.')) {
    if (node->is_array()) {
      const std::size_t index = index_of(*node, part);
      if (index >= node->size()) {
        throw ConfigError(file_, path, shorten(value),
                          "an index below " + std::to_string(node->size()) +
                              ", or the name of a sensor that stands there, where the key says " + part);
      }
      node = &(*node)[index];
      resolved = joined(resolved, std::to_string(index));
    } else if (node->is_object() || node->is_null()) {
      node = &(*node)[part];
      resolved = joined(resolved, part);
    } else {
      throw ConfigError(file_, path, shorten(value),
                        "a key that exists; the part before " + part + " is a single value");
    }
  }
  return *node;
}

void Layers::set(const std::string& set) {
  const auto equals = set.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError(file_, "--set " + shorten(set) + ": expected key.sub=value");
  const std::string path = set.substr(0, equals);
  const std::string value = set.substr(equals + 1);
  // What reads as JSON is taken as JSON; the rest is text, so that --set source.path=/dev/ttyS0 needs no
  // quotes.
  StrictJson parsed = parse_strict(value);
  if (parsed.fault && !reads_as_text(*parsed.fault)) {
    parsed.fault->key = path + "." + parsed.fault->key;
    throw ConfigError(file_, describe(*parsed.fault));
  }
  std::string resolved;
  json& node = node_at(path, value, resolved);
  replace(node, resolved, parsed.fault ? json(value) : std::move(parsed.value),
          {Layer::command_line, file_, path});
}

json read_file(const std::string& file) {
  StrictJson json = parse_strict(read_text(file));
  if (json.fault) {
    const JsonFault& fault = *json.fault;
    if (fault.kind == JsonFault::Kind::syntax)
      throw ConfigError(file + ":" + std::to_string(fault.line), "is not JSON: " + fault.is);
    throw ConfigError(file, describe(fault));
  }
  return std::move(json.value);
}

void Layers::read(const std::string& file) {
  const bool alone = value_.empty();
  json document = read_file(file);
  file_ = file;
  const Origin origin{Layer::override_, file, ""};
  if (alone) {
    mark("", origin);
    replace(value_, "", std::move(document), origin);
  } else if (document.is_object()) {
    merge(value_, "", document, origin);
  } else {
    Place{file, ""}.fail(document, "an object");
  }
}

std::string LoadRequest::name() const {
  return file.empty() && base ? base->file() : file;
}

Layers layers_of(const LoadRequest& request) {
  Layers out;
  if (request.base) out = *request.base;
  if (!request.file.empty() || !request.base) out.read(request.file);
  for (const std::string& set : request.sets) out.set(set);
  return out;
}

Document read_document(const LoadRequest& request) {
  auto layers = std::make_shared<const Layers>(layers_of(request));
  return {layers->value(), layers->file(), layers};
}

void Document::fail(const ConfigError& error) const {
  layers->fail(error);
}

}  // namespace fathom::config

#pragma once

// Strict JSON configuration: one description per struct yields the loader, the canonical dump (for the
// configuration hash) and the JSON Schema for editors. Included by config/*_config.cpp only; services include
// the plain structs and the load_... functions declared beside them.
//
//   struct Link { std::string host; int port = 0; double timeout_s = 1.0; };
//   inline void describe(Schema<Link>& s) {
//     s.field("host", &Link::host, "address of the device").required();
//     s.field("port", &Link::port, "TCP port").range(1, 65535);
//     s.field("timeout_s", &Link::timeout_s, "give up after").unit("s").range(0.01, 60);
//   }
//   Link link = load<Link>({file, sets});
//
// `describe` is found by argument-dependent lookup: declare it in namespace fathom::config (or T's) before
// use. Members may be bool, integers, double, std::string, Name, enums (with words), structs with a describe,
// and std::vector, std::array, std::optional and std::map<std::string, ...> of these.

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "config/error.hpp"
#include "config/registry.hpp"
#include "config/value.hpp"

namespace fathom::config {

/// Handle to refine a field after naming it.
template <class M>
class FieldRef {
 public:
  FieldRef(FieldInfo& info, std::shared_ptr<Rules<Leaf<M>>> rules) : info_(&info), rules_(std::move(rules)) {}

  /// Inclusive bounds of the number as written in the file.
  FieldRef& range(double low, double high) {
    rules_->low = low;
    rules_->high = high;
    return *this;
  }
  /// For documentation; the key should end in it as well.
  FieldRef& unit(std::string text) {
    info_->unit = std::move(text);
    return *this;
  }
  /// The file must give it: there is no safe default (frames, units, paths).
  FieldRef& required() {
    info_->required = true;
    return *this;
  }
  /// member = factor * number in the file; e.g. a key in degrees for a member in radians.
  FieldRef& scaled(double factor) {
    rules_->factor = factor;
    return *this;
  }
  /// null in the file means "unknown" (NaN); numbers only.
  FieldRef& nullable() {
    rules_->nullable = true;
    return *this;
  }
  /// The words of an enum, or the only strings allowed.
  FieldRef& words(std::vector<std::pair<std::string, Leaf<M>>> list) {
    rules_->words = std::move(list);
    return *this;
  }

 private:
  FieldInfo* info_;
  std::shared_ptr<Rules<Leaf<M>>> rules_;
};

/// The description of a configuration struct.
template <class T>
class Schema {
 public:
  template <class M>
  FieldRef<M> field(std::string key, M T::*member, std::string description) {
    auto rules = std::make_shared<Rules<Leaf<M>>>();
    auto entry = std::make_unique<Entry>();
    entry->info.key = std::move(key);
    entry->info.description = std::move(description);
    entry->load = [member, rules](const nlohmann::json& json, T& out, const Place& place) {
      load_value(json, out.*member, *rules, place);
    };
    entry->dump = [member, rules](const T& value) { return dump_value(value.*member, *rules); };
    entry->schema = [rules] { return value_schema<M>(*rules); };
    FieldInfo& info = entry->info;
    entries_.push_back(std::move(entry));
    return FieldRef<M>(info, rules);
  }

  /// All fields of `member`'s struct as fields of this one, without a level of nesting.
  template <class M>
  void include(M T::*member) {
    auto inner = std::make_shared<Schema<M>>();
    describe(*inner);
    for (auto& source : inner->entries_) {
      auto entry = std::make_unique<Entry>();
      entry->info = source->info;
      auto* raw = source.get();
      entry->load = [member, inner, raw](const nlohmann::json& json, T& out, const Place& place) {
        raw->load(json, out.*member, place);
      };
      entry->dump = [member, inner, raw](const T& value) { return raw->dump(value.*member); };
      entry->schema = [inner, raw] { return raw->schema(); };
      entries_.push_back(std::move(entry));
    }
    checks_.push_back([member, inner](const T& value) { return inner->violation(value.*member); });
  }

  /// A rule across fields. Returns {key, expectation} of the violated rule, or two empty strings.
  void check(std::function<std::pair<std::string, std::string>(const T&)> rule) {
    checks_.push_back(std::move(rule));
  }

  /// Throws ConfigError on anything that is not exactly as described. Fields that are absent keep their
  /// value.
  void load(const nlohmann::json& json, T& out, const Place& place) const {
    if (!json.is_object()) place.fail(json, "an object");
    for (const auto& [key, value] : json.items()) {
      if (key == "$schema" && place.key.empty()) continue;
      const Entry* entry = find(key);
      if (entry == nullptr) place.child(key).fail(value, "no such key; known keys: " + known_keys());
      entry->load(value, out, place.child(key));
    }
    for (const auto& entry : entries_) {
      if (entry->info.required && !json.contains(entry->info.key)) {
        place.child(entry->info.key).fail_missing(entry->info.description);
      }
    }
    const auto [key, expectation] = violation(out);
    if (!expectation.empty()) {
      const auto parent = key.empty() ? place : place.child(key);
      parent.fail(json.contains(key) ? json.at(key) : nlohmann::json(nullptr), expectation);
    }
  }

  [[nodiscard]] nlohmann::json dump(const T& value) const {
    nlohmann::json out = nlohmann::json::object();
    for (const auto& entry : entries_) out[entry->info.key] = entry->dump(value);
    return out;
  }

  [[nodiscard]] nlohmann::json json_schema() const {
    nlohmann::json properties = nlohmann::json::object();
    nlohmann::json required = nlohmann::json::array();
    const T defaults{};
    for (const auto& entry : entries_) {
      nlohmann::json property = entry->schema();
      property["description"] =
          entry->info.description + (entry->info.unit.empty() ? "" : " [" + entry->info.unit + "]");
      if (entry->info.required) {
        required.push_back(entry->info.key);
      } else {
        property["default"] = entry->dump(defaults);
      }
      properties[entry->info.key] = std::move(property);
    }
    nlohmann::json out = {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
    if (!required.empty()) out["required"] = required;
    return out;
  }

 private:
  template <class>
  friend class Schema;

  struct Entry {
    FieldInfo info;
    std::function<void(const nlohmann::json&, T&, const Place&)> load;
    std::function<nlohmann::json(const T&)> dump;
    std::function<nlohmann::json()> schema;
  };

  [[nodiscard]] const Entry* find(const std::string& key) const {
    for (const auto& entry : entries_) {
      if (entry->info.key == key) return entry.get();
    }
    return nullptr;
  }
  [[nodiscard]] std::string known_keys() const {
    std::string out;
    for (const auto& entry : entries_) out += (out.empty() ? "" : ", ") + entry->info.key;
    return out;
  }
  [[nodiscard]] std::pair<std::string, std::string> violation(const T& value) const {
    for (const auto& rule : checks_) {
      auto found = rule(value);
      if (!found.second.empty()) return found;
    }
    return {};
  }

  std::vector<std::unique_ptr<Entry>> entries_;
  std::vector<std::function<std::pair<std::string, std::string>(const T&)>> checks_;
};

/// The description of T.
template <class T>
[[nodiscard]] Schema<T> schema_of() {
  Schema<T> schema;
  describe(schema);
  return schema;
}

template <class M>
requires is_described<M>
void load_value(const nlohmann::json& json, M& out, const Rules<M>&, const Place& place) {
  schema_of<M>().load(json, out, place);
}
template <class M>
requires is_described<M> nlohmann::json dump_value(const M& value, const Rules<M>&) {
  return schema_of<M>().dump(value);
}
template <class M>
requires is_described<M> nlohmann::json described_schema() {
  return schema_of<M>().json_schema();
}

/// Reads the file, applies the overrides, checks everything. Throws ConfigError.
template <class T>
[[nodiscard]] T load(const LoadRequest& request) {
  const nlohmann::json json = read_json(request);
  T out{};
  schema_of<T>().load(json, out, Place{request.file, ""});
  return out;
}

/// The effective configuration as one canonical line: what the configuration hash is taken of.
template <class T>
[[nodiscard]] std::string canonical(const T& value) {
  return schema_of<T>().dump(value).dump();
}

/// The JSON Schema (draft 2020-12) of a whole file.
template <class T>
[[nodiscard]] std::string schema_text(const std::string& title) {
  nlohmann::json out = schema_of<T>().json_schema();
  out["$schema"] = "https://json-schema.org/draft/2020-12/schema";
  out["title"] = title;
  out["properties"]["$schema"] = {{"type", "string"}, {"description", "this schema, for editors"}};
  return out.dump(2) + "\n";
}

/// The entry of a file kind for registry.cpp; call it in that kind's *_config.cpp.
template <class T>
[[nodiscard]] ConfigKind make_kind(std::string_view name) {
  return {name, [] { return schema_text<T>("fathom"); }, [](const LoadRequest& request) { (void)load<T>(request); }};
}

}  // namespace fathom::config

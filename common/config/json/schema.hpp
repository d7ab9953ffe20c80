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

#include "base/field.hpp"
#include "config/explain.hpp"
#include "config/json/error.hpp"
#include "config/json/value.hpp"
#include "config/registry.hpp"

namespace fathom::config {

/// How members of one type are converted, their type forgotten: every field of that type in every struct
/// shares the code. `rules` points to the Rules of the member's leaf type.
struct MemberOps {
  void (*load)(const nlohmann::json& json, void* member, const void* rules, const Place& place);
  nlohmann::json (*dump)(const void* member, const void* rules);
  nlohmann::json (*schema)(const void* rules);
  std::string (*range)(const void* rules);
  /// The fields below this one, where it is a struct or holds structs; `member` has the defaults.
  void (*rows)(const void* member, const std::string& key, std::vector<FieldRow>& out);
};

template <class T>
class Schema;
template <class T>
[[nodiscard]] Schema<T> schema_of();

/// What stands behind the key of a container for each of its elements.
template <class M>
[[nodiscard]] constexpr const char* element_suffix() {
  if constexpr (requires(M m) { m.has_value(); })
    return "";
  else if constexpr (requires(M m) { m.begin()->second; })
    return ".*";
  else
    return "[]";
}

template <class M>
[[nodiscard]] const MemberOps& ops_of() {
  static constexpr MemberOps kOps{
      [](const nlohmann::json& json, void* member, const void* rules, const Place& place) {
        load_value(json, *static_cast<M*>(member), *static_cast<const Rules<Leaf<M>>*>(rules), place);
      },
      [](const void* member, const void* rules) {
        return dump_value(*static_cast<const M*>(member), *static_cast<const Rules<Leaf<M>>*>(rules));
      },
      [](const void* rules) { return value_schema<M>(*static_cast<const Rules<Leaf<M>>*>(rules)); },
      [](const void* rules) { return range_of<Leaf<M>>(*static_cast<const Rules<Leaf<M>>*>(rules)); },
      [](const void* member, const std::string& key, std::vector<FieldRow>& out) {
        if constexpr (is_described<M>) {
          schema_of<M>().list(*static_cast<const M*>(member), key, out);
        } else if constexpr (is_described<Leaf<M>>) {
          schema_of<Leaf<M>>().list(Leaf<M>{}, key + element_suffix<M>(), out);
        }
      }};
  return kOps;
}

// What nearly every struct has is compiled once, in schema.cpp.
extern template const MemberOps& ops_of<bool>();
extern template const MemberOps& ops_of<int>();
extern template const MemberOps& ops_of<std::int64_t>();
extern template const MemberOps& ops_of<std::uint8_t>();
extern template const MemberOps& ops_of<std::uint32_t>();
extern template const MemberOps& ops_of<std::uint64_t>();
extern template const MemberOps& ops_of<double>();
extern template const MemberOps& ops_of<std::string>();
extern template const MemberOps& ops_of<Name>();
extern template const MemberOps& ops_of<std::array<double, 2>>();
extern template const MemberOps& ops_of<std::array<double, 3>>();
extern template const MemberOps& ops_of<std::vector<double>>();
extern template const MemberOps& ops_of<std::vector<std::string>>();

/// The fields and rules of a struct whose type is forgotten: members are known by their offset.
class SchemaCore {
 public:
  /// A rule across fields. A complaint without a value is about what stands in the file under its key.
  struct Rule {
    std::function<std::vector<Complaint>(const void* whole)> complaints;
    bool of_parts = false;  ///< it makes sense also where some fields were refused
  };
  /// Makes of the struct what its fields are where the deciding one says `choice`.
  using Defaults = std::function<void(const std::string& choice, void* whole)>;

  FieldInfo& add(std::string key, std::string description, std::size_t offset, std::shared_ptr<void> rules,
                 const MemberOps& ops);
  /// Takes over the fields and rules of a struct that lies at `offset` in this one.
  void absorb(const SchemaCore& inner, std::size_t offset);
  void check(Rule rule) { checks_.push_back(std::move(rule)); }
  void defaults_by_choice(Defaults defaults) { defaults_ = std::move(defaults); }

  void load(const nlohmann::json& json, void* whole, const Place& place) const;
  [[nodiscard]] nlohmann::json dump(const void* whole) const;
  /// `spare` is another struct with the defaults, to be changed at will.
  [[nodiscard]] nlohmann::json json_schema(const void* defaults, void* spare) const;
  void list(const void* defaults, void* spare, const std::string& prefix, std::vector<FieldRow>& out) const;

 private:
  struct Entry {
    FieldInfo info;
    std::size_t offset = 0;
    std::shared_ptr<void> rules;
    const MemberOps* ops = nullptr;
  };

  [[nodiscard]] const Entry* find(const std::string& key) const;
  [[nodiscard]] std::string known_keys() const;
  [[nodiscard]] const Entry* deciding() const;
  /// Choice of the deciding field, which is loaded before the others; empty where there is none.
  [[nodiscard]] std::string load_choice(const nlohmann::json& json, void* whole, const Place& place) const;
  [[nodiscard]] std::string choice_of(const void* whole) const;
  [[nodiscard]] nlohmann::json schema_of_choice(const std::string& choice, const void* defaults,
                                                void* spare) const;
  /// The defaults of a field by the choices that know it; one for an empty choice where nothing decides.
  [[nodiscard]] std::vector<std::pair<std::string, nlohmann::json>> defaults_of(const Entry& entry,
                                                                                const void* defaults,
                                                                                void* spare) const;
  /// The keys of one object that nothing is known of.
  struct Strangers {
    std::vector<std::string> meant;  ///< the known ones that they are near to
    bool told_keys = false;          ///< the list of all known ones is long: it is said once
  };
  void load_field(const std::string& key, const nlohmann::json& value, void* whole, const std::string& choice,
                  const Place& place, Strangers& strangers) const;
  /// What the rules find, where the fields had these mistakes.
  [[nodiscard]] Mistakes check_rules(const nlohmann::json& json, const void* whole, const Place& place,
                                     const Mistakes& of_fields) const;

  std::vector<std::unique_ptr<Entry>> entries_;  // FieldRef keeps references to their info
  std::vector<Rule> checks_;
  Defaults defaults_;
};

/// The description of a configuration struct.
template <class T>
class Schema {
 public:
  template <class M, class Base>
  // NOLINTNEXTLINE(performance-unnecessary-value-param): both are moved on
  FieldRef<M> field(std::string key, M Base::*member, std::string description) {
    auto rules = std::make_shared<Rules<Leaf<M>>>();
    FieldInfo& info =
        core_.add(std::move(key), std::move(description), offset_of(member), rules, ops_of<M>());
    return FieldRef<M>(info, rules);
  }

  /// All fields of `member`'s struct as fields of this one, without a level of nesting.
  template <class M, class Base>
  void include(M Base::*member) {
    Schema<M> inner;
    describe(inner);
    core_.absorb(inner.core_, offset_of(member));
  }

  /// A rule across fields. Returns {key, expectation} of the violated rule, or two empty strings.
  void check(std::function<std::pair<std::string, std::string>(const T&)> rule) {
    const auto complaints = [rule = std::move(rule)](const void* whole) -> std::vector<Complaint> {
      auto [key, expectation] = rule(*static_cast<const T*>(whole));
      if (expectation.empty()) return {};
      return {{std::move(key), "", std::move(expectation)}};
    };
    core_.check({complaints});
  }
  /// A rule that finds several violations at once. It is asked also where some fields were refused, which
  /// then have their defaults; what it says of those is left out.
  void check_parts(std::function<std::vector<std::pair<std::string, std::string>>(const T&)> rule) {
    const auto complaints = [rule = std::move(rule)](const void* whole) {
      std::vector<Complaint> out;
      for (auto& [key, expectation] : rule(*static_cast<const T*>(whole)))
        out.push_back({std::move(key), "", std::move(expectation)});
      return out;
    };
    core_.check({complaints, true});
  }
  /// Likewise where the rule knows the value that is wrong.
  void check_values(std::function<std::optional<Complaint>(const T&)> rule) {
    const auto complaints = [rule = std::move(rule)](const void* whole) -> std::vector<Complaint> {
      auto found = rule(*static_cast<const T*>(whole));
      if (!found) return {};
      return {std::move(*found)};
    };
    core_.check({complaints});
  }
  /// The defaults where the deciding field says `choice`.
  void defaults_by_choice(std::function<T(const std::string& choice)> defaults) {
    core_.defaults_by_choice([defaults = std::move(defaults)](const std::string& choice, void* whole) {
      *static_cast<T*>(whole) = defaults(choice);
    });
  }

  /// Throws ConfigError of everything that is not exactly as described. Fields that are absent or refused
  /// keep their value.
  void load(const nlohmann::json& json, T& out, const Place& place) const { core_.load(json, &out, place); }
  [[nodiscard]] nlohmann::json dump(const T& value) const { return core_.dump(&value); }
  [[nodiscard]] nlohmann::json json_schema() const {
    T spare{};
    return core_.json_schema(&probe_, &spare);
  }
  void list(const T& defaults, const std::string& prefix, std::vector<FieldRow>& out) const {
    T spare{};
    core_.list(&defaults, &spare, prefix, out);
  }

 private:
  template <class>
  friend class Schema;

  template <class M, class Base>
  [[nodiscard]] std::size_t offset_of(M Base::*member) const {
    return static_cast<std::size_t>(reinterpret_cast<const char*>(&(probe_.*member)) -
                                    reinterpret_cast<const char*>(&probe_));
  }

  T probe_{};  // the defaults
  SchemaCore core_;
};

/// The description of T.
template <class T>
Schema<T> schema_of() {
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
  const Document document = read_document(request);
  T out{};
  try {
    schema_of<T>().load(document.value, out, Place{document.file, ""});
  } catch (const ConfigError& error) {
    document.fail(error);
  }
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

/// Every key of a whole file.
template <class T>
[[nodiscard]] std::vector<FieldRow> rows_of() {
  std::vector<FieldRow> out;
  schema_of<T>().list(T{}, "", out);
  return out;
}

/// The entry of a file kind for registry.cpp; call it in that kind's *_config.cpp.
template <class T>
[[nodiscard]] ConfigKind make_kind(std::string_view name) {
  ConfigKind kind{name, [] { return schema_text<T>("fathom"); },
                  [](const LoadRequest& request) { (void)load<T>(request); }, rows_of<T>};
  kind.effective = [](const LoadRequest& request) { return canonical(load<T>(request)); };
  return kind;
}

}  // namespace fathom::config

#include "config/json/schema.hpp"

namespace fathom::config {
namespace {

void* at(void* whole, std::size_t offset) {
  return static_cast<char*>(whole) + offset;
}
const void* at(const void* whole, std::size_t offset) {
  return static_cast<const char*>(whole) + offset;
}

}  // namespace

template const MemberOps& ops_of<bool>();
template const MemberOps& ops_of<int>();
template const MemberOps& ops_of<std::int64_t>();
template const MemberOps& ops_of<std::uint8_t>();
template const MemberOps& ops_of<std::uint32_t>();
template const MemberOps& ops_of<std::uint64_t>();
template const MemberOps& ops_of<double>();
template const MemberOps& ops_of<std::string>();
template const MemberOps& ops_of<Name>();
template const MemberOps& ops_of<std::array<double, 2>>();
template const MemberOps& ops_of<std::array<double, 3>>();
template const MemberOps& ops_of<std::vector<double>>();
template const MemberOps& ops_of<std::vector<std::string>>();

FieldInfo& SchemaCore::add(std::string key, std::string description, std::size_t offset,
                           std::shared_ptr<void> rules, const MemberOps& ops) {
  auto entry = std::make_unique<Entry>();
  entry->info = {std::move(key), std::move(description), "", false};
  entry->offset = offset;
  entry->rules = std::move(rules);
  entry->ops = &ops;
  entries_.push_back(std::move(entry));
  return entries_.back()->info;
}

void SchemaCore::absorb(const SchemaCore& inner, std::size_t offset) {
  for (const auto& entry : inner.entries_) {
    entries_.push_back(std::make_unique<Entry>(*entry));
    entries_.back()->offset += offset;
  }
  for (const auto& rule : inner.checks_) {
    checks_.push_back([rule, offset](const void* whole) { return rule(at(whole, offset)); });
  }
}

void SchemaCore::load(const nlohmann::json& json, void* whole, const Place& place) const {
  if (!json.is_object()) place.fail(json, "an object");
  for (const auto& [key, value] : json.items()) {
    if (key == "$schema" && place.key.empty()) continue;
    const Entry* entry = find(key);
    if (entry == nullptr) place.child(key).fail(value, "no such key; known keys: " + known_keys());
    entry->ops->load(value, at(whole, entry->offset), entry->rules.get(), place.child(key));
  }
  for (const auto& entry : entries_) {
    if (entry->info.required && !json.contains(entry->info.key)) {
      place.child(entry->info.key).fail_missing(entry->info.description);
    }
  }
  const auto [key, expectation] = violation(whole);
  if (expectation.empty()) return;
  const Place where = key.empty() ? place : place.child(key);
  where.fail(json.contains(key) ? json.at(key) : nlohmann::json(nullptr), expectation);
}

nlohmann::json SchemaCore::dump(const void* whole) const {
  nlohmann::json out = nlohmann::json::object();
  for (const auto& entry : entries_) {
    out[entry->info.key] = entry->ops->dump(at(whole, entry->offset), entry->rules.get());
  }
  return out;
}

nlohmann::json SchemaCore::json_schema(const void* defaults) const {
  nlohmann::json properties = nlohmann::json::object();
  nlohmann::json required = nlohmann::json::array();
  for (const auto& entry : entries_) {
    nlohmann::json property = entry->ops->schema(entry->rules.get());
    property["description"] =
        entry->info.description + (entry->info.unit.empty() ? "" : " [" + entry->info.unit + "]");
    if (entry->info.required) {
      required.push_back(entry->info.key);
    } else {
      property["default"] = entry->ops->dump(at(defaults, entry->offset), entry->rules.get());
    }
    properties[entry->info.key] = std::move(property);
  }
  nlohmann::json out = {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
  if (!required.empty()) out["required"] = required;
  return out;
}

const SchemaCore::Entry* SchemaCore::find(const std::string& key) const {
  for (const auto& entry : entries_) {
    if (entry->info.key == key) return entry.get();
  }
  return nullptr;
}

std::string SchemaCore::known_keys() const {
  std::string out;
  for (const auto& entry : entries_) out += (out.empty() ? "" : ", ") + entry->info.key;
  return out;
}

SchemaCore::Violation SchemaCore::violation(const void* whole) const {
  for (const auto& rule : checks_) {
    auto found = rule(whole);
    if (!found.second.empty()) return found;
  }
  return {};
}

}  // namespace fathom::config

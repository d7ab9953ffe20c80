#include "config/json/schema.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

#include "base/nearest.hpp"

namespace fathom::config {
namespace {

void* at(void* whole, std::size_t offset) {
  return static_cast<char*>(whole) + offset;
}
const void* at(const void* whole, std::size_t offset) {
  return static_cast<const char*>(whole) + offset;
}

bool contains(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

/// What stands at a dotted path; null where nothing does.
nlohmann::json below(const nlohmann::json& json, const std::string& path) {
  const nlohmann::json* node = &json;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    if (node->is_object() && node->contains(part)) {
      node = &node->at(part);
    } else if (node->is_array() && part.find_first_not_of("0123456789") == std::string::npos &&
               std::stoul(part) < node->size()) {
      node = &node->at(std::stoul(part));
    } else {
      return nullptr;
    }
  }
  return *node;
}

/// A default for people: what a factor left behind the sixth digit says nothing.
std::string short_text(const nlohmann::json& value) {
  std::ostringstream out;
  if (value.is_number_float()) {
    out << value.get<double>();
  } else if (value.is_array()) {
    const char* before = "[";
    if (value.empty()) out << before;
    for (const auto& element : value) out << std::exchange(before, ", ") << short_text(element);
    out << "]";
  } else {
    out << value.dump();
  }
  return out.str();
}

/// One default, or "21 for gps, 5 for dvl, depth" where they differ.
std::string text_of(const std::vector<std::pair<std::string, nlohmann::json>>& defaults) {
  std::vector<std::pair<std::string, std::vector<std::string>>> texts;
  for (const auto& [choice, value] : defaults) {
    const std::string text = short_text(value);
    auto same = std::find_if(texts.begin(), texts.end(), [&](const auto& one) { return one.first == text; });
    if (same == texts.end()) same = texts.insert(texts.end(), {text, {}});
    same->second.push_back(choice);
  }
  std::string out;
  for (const auto& [text, choices] : texts) {
    if (!out.empty()) out += "; ";
    out += texts.size() == 1 ? text : text + " for " + list_words(choices);
  }
  return out;
}

/// The sentence, behind the choices that it is for.
std::string text_of(const FieldInfo& info) {
  return (info.only_for.empty() ? "" : list_words(info.only_for) + ": ") + info.sentence;
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
  entry->info = {std::move(key), std::move(description)};
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
    checks_.push_back(
        {[rule, offset](const void* whole) { return rule.complaints(at(whole, offset)); }, rule.of_parts});
  }
}

void SchemaCore::load(const nlohmann::json& json, void* whole, const Place& place) const {
  if (!json.is_object()) place.fail(json, "an object");
  Mistakes mistakes;
  std::string choice;
  // A decider that was refused is complained of once.
  const bool chosen = mistakes.in([&] { choice = load_choice(json, whole, place); });
  const Entry* refused = chosen ? nullptr : deciding();
  Strangers strangers;
  for (const auto& item : json.items()) {
    if (refused != nullptr && refused->info.key == item.key()) continue;
    mistakes.in([&] { load_field(item.key(), item.value(), whole, choice, place, strangers); });
  }
  for (const auto& entry : entries_) {
    if (json.contains(entry->info.key) || entry.get() == refused) continue;
    if (contains(strangers.meant, entry->info.key)) continue;  // it is there, mistyped
    if (entry->info.required || contains(entry->info.required_for, choice))
      mistakes.in([&] { place.child(entry->info.key).fail_missing(entry->info.sentence); });
  }
  // A rule does not complain of what is mistyped either.
  Mistakes of_fields = mistakes;
  for (const std::string& key : strangers.meant)
    of_fields.in([&] { place.child(key).fail_missing("what was mistyped"); });
  const Mistakes of_rules = check_rules(json, whole, place, of_fields);
  mistakes.in([&] { of_rules.raise(); });
  mistakes.raise();
}

void SchemaCore::load_field(const std::string& key, const nlohmann::json& value, void* whole,
                            const std::string& choice, const Place& place, Strangers& strangers) const {
  if (key == "$schema" && place.key.empty()) return;
  if (key == "$comment") {
    if (!value.is_string()) place.child(key).fail(value, "a text");
    return;
  }
  const Entry* entry = find(key);
  if (entry == nullptr) {
    std::vector<std::string> keys;
    for (const auto& one : entries_) keys.push_back(one->info.key);
    const auto meant = nearest(key, keys);
    std::string expectation = "no such key";
    if (meant) {
      expectation += "; the nearest is " + *meant;
      strangers.meant.push_back(*meant);
    }
    if (!std::exchange(strangers.told_keys, true)) expectation += "; known keys: " + known_keys();
    place.child(key).fail(value, expectation);
  }
  if (!choice.empty() && !entry->info.known_to(choice)) {
    const std::string& decider = deciding()->info.key;
    place.child(key).fail(value, "no such key where " + decider + " is " + choice + "; it is known where " +
                                     decider + " is one of " + list_words(entry->info.only_for));
  }
  entry->ops->load(value, at(whole, entry->offset), entry->rules.get(), place.child(key));
}

std::string SchemaCore::load_choice(const nlohmann::json& json, void* whole, const Place& place) const {
  const Entry* decider = deciding();
  if (decider == nullptr) return "";
  const FieldInfo& info = decider->info;
  if (json.contains(info.key)) {
    decider->ops->load(json.at(info.key), at(whole, decider->offset), decider->rules.get(),
                       place.child(info.key));
  } else if (info.required) {
    place.child(info.key).fail_missing(info.sentence);
  }
  std::string choice = choice_of(whole);
  if (defaults_ && !choice.empty()) defaults_(choice, whole);
  return choice;
}

std::string SchemaCore::choice_of(const void* whole) const {
  const Entry* decider = deciding();
  if (decider == nullptr) return "";
  const nlohmann::json word = decider->ops->dump(at(whole, decider->offset), decider->rules.get());
  if (!word.is_string()) return "";
  const auto text = word.get<std::string>();
  return decider->info.choice_of == nullptr ? text : decider->info.choice_of(text);
}

Mistakes SchemaCore::check_rules(const nlohmann::json& json, const void* whole, const Place& place,
                                 const Mistakes& of_fields) const {
  Mistakes out;
  for (const Rule& rule : checks_) {
    if (!of_fields.none() && !rule.of_parts) continue;
    for (const Complaint& found : rule.complaints(whole)) {
      const Place where = found.key.empty() ? place : place.child(found.key);
      if (of_fields.about(where.key)) continue;
      const nlohmann::json written = found.key.empty() ? json : below(json, found.key);
      out.in([&] {
        if (written.is_null() && !found.value.empty()) where.fail_text(found.value, found.expectation);
        where.fail(written, found.expectation);
      });
    }
  }
  return out;
}

nlohmann::json SchemaCore::dump(const void* whole) const {
  nlohmann::json out = nlohmann::json::object();
  for (const auto& entry : entries_) {
    out[entry->info.key] = entry->ops->dump(at(whole, entry->offset), entry->rules.get());
  }
  return out;
}

nlohmann::json SchemaCore::json_schema(const void* defaults, void* spare) const {
  nlohmann::json properties = nlohmann::json::object();
  nlohmann::json required = nlohmann::json::array();
  for (const auto& entry : entries_) {
    nlohmann::json property = entry->ops->schema(entry->rules.get());
    property["description"] =
        text_of(entry->info) + (entry->info.unit.empty() ? "" : " [" + entry->info.unit + "]");
    if (entry->info.required) {
      required.push_back(entry->info.key);
    } else {
      // Where no choice has it, each says its own.
      auto standard = entry->ops->dump(at(defaults, entry->offset), entry->rules.get());
      for (const auto& [choice, own] : defaults_of(*entry, defaults, spare)) {
        if (own == standard) property["default"] = standard;
      }
    }
    properties[entry->info.key] = std::move(property);
  }
  properties["$comment"] = {{"type", "string"},
                            {"description", "where the values come from; it has no effect"}};
  nlohmann::json out = {{"type", "object"}, {"additionalProperties", false}, {"properties", properties}};
  if (!required.empty()) out["required"] = required;
  const Entry* decider = deciding();
  if (decider == nullptr) return out;
  for (const std::string& choice : decider->info.choices) {
    nlohmann::json then = schema_of_choice(choice, defaults, spare);
    if (then.empty()) continue;
    const nlohmann::json condition = {{"properties", {{decider->info.key, {{"const", choice}}}}},
                                      {"required", nlohmann::json::array({decider->info.key})}};
    out["allOf"].push_back({{"if", condition}, {"then", std::move(then)}});
  }
  return out;
}

nlohmann::json SchemaCore::schema_of_choice(const std::string& choice, const void* defaults,
                                            void* spare) const {
  nlohmann::json out = nlohmann::json::object();
  if (defaults_) defaults_(choice, spare);
  for (const auto& entry : entries_) {
    const std::string& key = entry->info.key;
    if (!entry->info.known_to(choice)) {
      out["properties"][key] = false;
      continue;
    }
    if (contains(entry->info.required_for, choice)) {
      out["required"].push_back(key);
    } else if (defaults_ && !entry->info.required) {
      const auto own = entry->ops->dump(at(spare, entry->offset), entry->rules.get());
      if (own != entry->ops->dump(at(defaults, entry->offset), entry->rules.get()))
        out["properties"][key]["default"] = own;
    }
  }
  return out;
}

std::vector<std::pair<std::string, nlohmann::json>> SchemaCore::defaults_of(const Entry& entry,
                                                                            const void* defaults,
                                                                            void* spare) const {
  const Entry* decider = deciding();
  if (decider == nullptr || !defaults_)
    return {{"", entry.ops->dump(at(defaults, entry.offset), entry.rules.get())}};
  std::vector<std::pair<std::string, nlohmann::json>> out;
  for (const std::string& choice : decider->info.choices) {
    if (!entry.info.known_to(choice)) continue;
    defaults_(choice, spare);
    out.emplace_back(choice, entry.ops->dump(at(spare, entry.offset), entry.rules.get()));
  }
  return out;
}

void SchemaCore::list(const void* defaults, void* spare, const std::string& prefix,
                      std::vector<FieldRow>& out) const {
  for (const auto& entry : entries_) {
    FieldRow row{prefix.empty() ? entry->info.key : prefix + "." + entry->info.key, entry->info, "", ""};
    row.info.sentence = text_of(entry->info);
    row.range = row.info.decides() ? list_words(row.info.choices) : entry->ops->range(entry->rules.get());
    const std::size_t place = out.size();
    entry->ops->rows(at(defaults, entry->offset), row.key, out);
    const bool section = out.size() > place;
    if (!section && !entry->info.required) row.default_text = text_of(defaults_of(*entry, defaults, spare));
    out.insert(out.begin() + static_cast<std::ptrdiff_t>(place), std::move(row));
  }
}

const SchemaCore::Entry* SchemaCore::deciding() const {
  for (const auto& entry : entries_) {
    if (entry->info.decides()) return entry.get();
  }
  return nullptr;
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

}  // namespace fathom::config

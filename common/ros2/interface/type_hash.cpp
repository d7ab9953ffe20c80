#include <array>
#include <set>
#include <stdexcept>

#include <openssl/sha.h>

#include "ros2/interface/description.hpp"

namespace fathom::ros2 {
namespace {

/// Text of the signs that interfaces are named with: nothing of it has to be escaped.
std::string quoted(const std::string& text) {
  return "\"" + text + "\"";
}

std::string json_of(const TypeDescription& type) {
  std::string out = R"({"type_name": )" + quoted(type.name) + R"(, "fields": [)";
  for (std::size_t i = 0; i < type.fields.size(); ++i) {
    const FieldDescription& field = type.fields[i];
    const int id = static_cast<int>(field.basic) + static_cast<int>(field.container);
    out += (i == 0 ? "" : ", ") + (R"({"name": )" + quoted(field.name)) + R"(, "type": {"type_id": )" +
           std::to_string(id) + R"(, "capacity": )" + std::to_string(field.capacity) +
           R"(, "string_capacity": )" + std::to_string(field.string_capacity) + R"(, "nested_type_name": )" +
           quoted(field.nested_type) + "}}";
  }
  return out + "]}";
}

/// Adds what `type` is made of. Returns the name of a type that is not there.
std::string collect(const Interfaces& interfaces, const TypeDescription& type, std::set<std::string>& found) {
  for (const FieldDescription& field : type.fields) {
    if (field.basic != Basic::nested || !found.insert(field.nested_type).second) continue;
    const auto nested = interfaces.find(field.nested_type);
    if (nested == interfaces.end()) return field.nested_type;
    if (std::string missing = collect(interfaces, nested->second, found); !missing.empty()) return missing;
  }
  return {};
}

}  // namespace

Result<std::string> type_hash(const Interfaces& interfaces, std::string_view type) {
  const auto root = interfaces.find(std::string(type));
  if (root == interfaces.end())
    return Error{"interface " + std::string(type) + ": expected one that is known"};
  std::set<std::string> referenced;
  if (const std::string missing = collect(interfaces, root->second, referenced); !missing.empty()) {
    return Error{"interface " + std::string(type) + ": is made of " + missing + ", which is not known"};
  }
  std::string json =
      R"({"type_description": )" + json_of(root->second) + R"(, "referenced_type_descriptions": [)";
  bool first = true;
  for (const std::string& name : referenced) {
    json += (first ? "" : ", ") + json_of(interfaces.at(name));
    first = false;
  }
  json += "]}";
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(json.data()), json.size(), digest.data());
  std::string out = "RIHS01_";
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const unsigned char byte : digest) {
    out += kDigits[byte >> 4U];
    out += kDigits[byte & 15U];
  }
  return out;
}

namespace {

Interfaces read_all(Distro distro) {
  constexpr std::string_view kGraph = "rmw_dds_common.idl";
  constexpr std::string_view kGraphOfHumble = "rmw_dds_common_humble.idl";
  const std::string_view other = distro == Distro::humble ? kGraph : kGraphOfHumble;
  Interfaces out;
  for (const InterfaceFile& file : interface_files()) {
    if (file.name == other) continue;
    auto found = parse_idl(file.text);
    if (!found) throw std::logic_error(std::string(file.name) + ": " + found.error().message);
    out.merge(found.value());
  }
  return out;
}

}  // namespace

const Interfaces& interfaces_of(Distro distro) {
  static const Interfaces humble = read_all(Distro::humble);
  static const Interfaces later = read_all(Distro::jazzy);
  return distro == Distro::humble ? humble : later;
}

}  // namespace fathom::ros2

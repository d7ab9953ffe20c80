#include "samples/kinds.hpp"

#include <algorithm>
#include <vector>

namespace fathom {

std::string_view to_string(SourceKind source) {
  std::string_view word = "unknown";
  for_each_kind([&](auto kind) {
    if (kind.kSource == source) word = kind.kWord;
  });
  return word;
}

std::optional<SourceKind> kind_named(std::string_view word) {
  std::optional<SourceKind> source;
  for_each_kind([&](auto kind) {
    if (kind.kWord == word) source = kind.kSource;
  });
  return source;
}

std::string_view role_of(SourceKind source) {
  std::string_view role = "unknown";
  for_each_kind([&](auto kind) {
    if (kind.kSource == source) role = kind.kRole;
  });
  return role;
}

std::span<const std::string_view> bridge_roles() {
  static const std::vector<std::string_view> kRoles = [] {
    std::vector<std::string_view> roles;
    for_each_kind([&](auto kind) {
      if (std::find(roles.begin(), roles.end(), kind.kRole) == roles.end()) roles.push_back(kind.kRole);
    });
    return roles;
  }();
  return kRoles;
}

}  // namespace fathom

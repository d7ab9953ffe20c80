#pragma once

#include <span>
#include <string_view>

namespace fathom::security {

/// What one identity of the vehicle network may do. Topics are full names; `*` stands for any characters.
struct Role {
  std::string_view name;  ///< of the identity: the service's name
  std::span<const std::string_view> publishes;
  std::span<const std::string_view> subscribes;
};

/// The one table that the signed permissions are made of: every identity that `fathom keygen` makes.
[[nodiscard]] std::span<const Role> roles();
/// Nothing when no identity has this name.
[[nodiscard]] const Role* find_role(std::string_view name);

}  // namespace fathom::security

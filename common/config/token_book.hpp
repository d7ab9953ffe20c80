#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::config {

/// What somebody may do, in the order of growing.
enum class Role : std::uint8_t { nobody = 0, viewer = 1, operator_ = 2 };
[[nodiscard]] std::string_view to_string(Role role);

struct Identity {
  std::string name;  ///< for the log; empty: no token was shown
  Role role = Role::nobody;
};

/// A token file that cannot be used; the message says what was wrong and what was expected.
class TokenError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Who holds which token.
class TokenBook {
 public:
  TokenBook() = default;
  /// The text of a token file: {"tokens": [{"name": "bridge", "role": "operator", "token": "..."}]}. Strict.
  /// Throws TokenError.
  [[nodiscard]] static TokenBook parse(std::string_view text);
  /// Reads a file that nobody but its owner may read. Throws TokenError.
  [[nodiscard]] static TokenBook load(const std::string& path);

  /// Takes the same time whatever the token and however much of it is right. Nobody for an unknown one.
  [[nodiscard]] Identity whois(std::string_view token) const;
  [[nodiscard]] bool empty() const { return entries_.empty(); }

 private:
  struct Entry {
    Identity identity;
    std::string token;
  };
  std::vector<Entry> entries_;
};

}  // namespace fathom::config

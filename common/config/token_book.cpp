#include "config/token_book.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "base/disk/regular_file.hpp"
#include "config/json/strict_json.hpp"

namespace fathom::config {
namespace {

using nlohmann::json;
constexpr std::size_t kMostBytes = 1UL << 20U;
constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLongestToken = 256;
constexpr std::size_t kLongestName = 20;  // "console:" and the name fit the name of a command's writer

/// The same work for every pair of texts of at most kLongestToken bytes.
bool equal_in_constant_time(std::string_view known, std::string_view shown) {
  unsigned difference = known.size() == shown.size() ? 0U : 1U;
  for (std::size_t i = 0; i < kLongestToken; ++i) {
    const unsigned a = i < known.size() ? static_cast<unsigned char>(known[i]) : 0U;
    const unsigned b = i < shown.size() ? static_cast<unsigned char>(shown[i]) : 0U;
    difference |= a ^ b;
  }
  return difference == 0;
}

bool printable(const std::string& text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < '\x7f'; });
}

std::string text_of(const json& entry, const char* key) {
  if (!entry.contains(key) || !entry[key].is_string()) {
    throw TokenError("tokens: every entry needs name, role and token, all of them text");
  }
  return entry[key].get<std::string>();
}

}  // namespace

std::string_view to_string(Role role) {
  switch (role) {
    case Role::viewer:
      return "viewer";
    case Role::operator_:
      return "operator";
    case Role::nobody:
      break;
  }
  return "nobody";
}

TokenBook TokenBook::parse(std::string_view text) {
  const config::StrictJson parsed = config::parse_strict(text);
  // Without the value in question: it may be a token.
  if (parsed.fault) {
    const std::string& key = parsed.fault->key;
    throw TokenError((key.empty() ? "" : key + ": ") + "expected strict JSON with each key once");
  }
  const json& root = parsed.value;
  if (!root.is_object() || root.size() != 1 || !root.contains("tokens") || !root["tokens"].is_array()) {
    throw TokenError("expected an object with one key, tokens, an array");
  }
  TokenBook book;
  for (const json& entry : root["tokens"]) {
    if (!entry.is_object() || entry.size() != 3) {
      throw TokenError("tokens: every entry needs name, role and token and nothing else");
    }
    Entry out;
    out.identity.name = text_of(entry, "name");
    out.token = text_of(entry, "token");
    const std::string role = text_of(entry, "role");
    if (role == "viewer") {
      out.identity.role = Role::viewer;
    } else if (role == "operator") {
      out.identity.role = Role::operator_;
    } else {
      throw TokenError("tokens: role '" + role + "': expected viewer or operator");
    }
    const std::string& name = out.identity.name;
    if (name.empty() || name.size() > kLongestName || !printable(name)) {
      throw TokenError("tokens: a name has 1 to 20 printable characters without blanks");
    }
    if (out.token.size() < kShortestToken || out.token.size() > kLongestToken || !printable(out.token)) {
      throw TokenError("tokens: the token of " + name +
                       " must have 16 to 256 printable characters without blanks");
    }
    book.entries_.push_back(std::move(out));
  }
  if (book.entries_.empty()) throw TokenError("tokens: expected at least one entry");
  return book;
}

TokenBook TokenBook::load(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) throw TokenError(path + ": cannot be read, expected a token file");
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    throw TokenError(path + ": others may read or write it, expected mode 0600");
  }
  const auto text = read_regular_file(path, kMostBytes);
  if (!text) throw TokenError(path + ": " + text.error().message);
  try {
    return parse(text.value());
  } catch (const TokenError& error) {
    throw TokenError(path + ": " + error.what());
  }
}

Identity TokenBook::whois(std::string_view token) const {
  Identity found;
  for (const Entry& entry : entries_) {
    if (equal_in_constant_time(entry.token, token)) found = entry.identity;
  }
  return found;
}

}  // namespace fathom::config

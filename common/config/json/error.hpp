#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace fathom::config {

/// A configuration that cannot be used. what(): "FILE: key: is VALUE, expected EXPECTATION" in one line.
class ConfigError : public std::runtime_error {
 public:
  ConfigError(const std::string& file, const std::string& key, const std::string& value,
              const std::string& expectation);
  /// For what has no key: an unreadable file, text that is not JSON.
  ConfigError(const std::string& file, const std::string& problem);
};

/// What to load: a file and the command line's `key.sub=value` overrides, applied in order.
struct LoadRequest {
  std::string file;
  std::vector<std::string> sets;
};

}  // namespace fathom::config

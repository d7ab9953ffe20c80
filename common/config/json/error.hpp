#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace fathom::config {

class Layers;

/// A configuration that cannot be used. what(): "FILE: key: is VALUE, expected EXPECTATION" in one line.
class ConfigError : public std::runtime_error {
 public:
  ConfigError(const std::string& file, const std::string& key, const std::string& value,
              const std::string& expectation);
  /// For what has no key: an unreadable file, text that is not JSON.
  ConfigError(const std::string& file, const std::string& problem);

  [[nodiscard]] const std::string& file() const { return file_; }
  /// Empty where the error has no key.
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] const std::string& value() const { return value_; }
  [[nodiscard]] const std::string& expectation() const { return expectation_; }

 private:
  std::string file_, key_, value_, expectation_;
};

/// What to load: a file and the command line's `key.sub=value` overrides, applied in order. Where there is a
/// base (what the file of a vehicle says of the service), the file is merged over it and may be absent.
struct LoadRequest {
  std::string file;
  std::vector<std::string> sets;
  std::shared_ptr<const Layers> base{};

  /// The file that complaints are about: its own, else that of the base.
  [[nodiscard]] std::string name() const;
};

}  // namespace fathom::config

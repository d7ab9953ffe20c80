#pragma once

#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fathom::config {

class Layers;

/// A configuration that cannot be used. what(): "FILE: key: is VALUE, expected EXPECTATION" in one line for
/// each mistake; file() and the rest are of the first one.
class ConfigError : public std::runtime_error {
 public:
  ConfigError(const std::string& file, const std::string& key, const std::string& value,
              const std::string& expectation);
  /// For what has no key: an unreadable file, text that is not JSON.
  ConfigError(const std::string& file, const std::string& problem);
  /// Several mistakes, at least one.
  explicit ConfigError(std::vector<ConfigError> mistakes);

  /// Each mistake by itself.
  [[nodiscard]] std::vector<ConfigError> each() const;
  [[nodiscard]] const std::string& file() const { return file_; }
  /// Empty where the error has no key.
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] const std::string& value() const { return value_; }
  [[nodiscard]] const std::string& expectation() const { return expectation_; }

 private:
  std::string file_, key_, value_, expectation_;
  std::shared_ptr<const std::vector<ConfigError>> several_;  // null where it is one
};

/// Collects what is wrong, so that a person hears of all of it at once.
class Mistakes {
 public:
  /// Does the step and keeps what it complains of. False where it did.
  template <class Step>
  bool in(Step&& step) {
    try {
      std::forward<Step>(step)();
      return true;
    } catch (const ConfigError& error) {
      add(error);
      return false;
    }
  }
  /// What was said already is not said again.
  void add(const ConfigError& error);
  [[nodiscard]] bool none() const { return all_.empty(); }
  /// Whether one is known of this key, or of what it stands in.
  [[nodiscard]] bool about(const std::string& key) const;
  /// Throws them, where there are any, as one.
  void raise() const;

 private:
  std::vector<ConfigError> all_;
  std::set<std::string> said_;
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

#include "config/json/error.hpp"

#include <algorithm>
#include <cstddef>

#include "config/json/strict_json.hpp"

namespace fathom::config {
namespace {

/// A file that is not of this kind at all has a mistake in each line.
constexpr std::size_t kMostLines = 20;

std::string lines_of(const std::vector<ConfigError>& mistakes) {
  std::string out;
  const std::size_t shown = std::min(mistakes.size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) out += (i == 0 ? "" : "\n") + std::string(mistakes[i].what());
  if (const std::size_t more = mistakes.size() - shown; more > 0)
    out += "\n" + mistakes.front().file() + ": and " + std::to_string(more) + " more";
  return out;
}

}  // namespace

ConfigError::ConfigError(const std::string& file, const std::string& key, const std::string& value,
                         const std::string& expectation)
    : std::runtime_error(one_line(file + ": " + key + ": is " + value + ", expected " + expectation)),
      file_(file),
      key_(key),
      value_(value),
      expectation_(expectation) {}

ConfigError::ConfigError(const std::string& file, const std::string& problem)
    : std::runtime_error(one_line(file + ": " + problem)), file_(file) {}

ConfigError::ConfigError(std::vector<ConfigError> mistakes)
    : std::runtime_error(lines_of(mistakes)),
      file_(mistakes.front().file_),
      key_(mistakes.front().key_),
      value_(mistakes.front().value_),
      expectation_(mistakes.front().expectation_),
      several_(std::make_shared<const std::vector<ConfigError>>(std::move(mistakes))) {}

std::vector<ConfigError> ConfigError::each() const {
  return several_ ? *several_ : std::vector<ConfigError>{*this};
}

void Mistakes::add(const ConfigError& error) {
  for (const ConfigError& one : error.each()) {
    if (said_.insert(one.what()).second) all_.push_back(one);
  }
}

bool Mistakes::about(const std::string& key) const {
  return std::any_of(all_.begin(), all_.end(), [&](const ConfigError& one) {
    return key == one.key() || (key.starts_with(one.key()) && key[one.key().size()] == '.');
  });
}

void Mistakes::raise() const {
  if (all_.size() == 1) throw ConfigError(all_.front());
  if (!all_.empty()) throw ConfigError(all_);
}

}  // namespace fathom::config

#pragma once

// A configuration document put together from several, which remembers where each value came from.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "config/json/error.hpp"

namespace fathom::config {

/// From the least to the most particular.
enum class Layer : std::uint8_t {
  standard = 0,   ///< nobody said it
  catalogue = 1,  ///< the instrument's model
  vehicle = 2,    ///< the file of the vehicle
  override_ = 3,  ///< the service's own file
  command_line = 4,
};
/// "default", "catalogue", "vehicle", "override", "command line".
[[nodiscard]] std::string_view to_string(Layer layer);

/// Where a value stands.
struct Origin {
  Layer layer = Layer::standard;
  std::string file;  ///< empty: in no file; of the command line, the file that it overrides
  std::string key;   ///< dotted path there

  [[nodiscard]] Origin child(const std::string& part) const {
    return {layer, file, key.empty() ? part : key + "." + part};
  }
};

/// The document so far. Keys are dotted paths; elements of arrays are named by their index.
class Layers {
 public:
  Layers() = default;
  /// `file`: what complaints are about, and what paths inside are relative to.
  explicit Layers(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  /// Merges `document` over what stands at `key`. Objects are merged key by key. An array of objects that
  /// have names (`name`, or `sensor`) is merged by them, and by their `kind` where both say it: what is not
  /// there yet is appended. Anything else replaces.
  void overlay(const std::string& key, const nlohmann::json& document, const Origin& origin);
  /// Appends an empty object to the array at `key`.
  void grow(const std::string& key);
  /// Says where what is missing at `key` and below it should stand; only complaints go by it.
  void mark(const std::string& key, Origin origin) { marks_[key] = std::move(origin); }

  [[nodiscard]] const nlohmann::json& value() const { return value_; }
  /// Of the value at `key`, of a list or section the most particular one inside; standard where nobody said
  /// it.
  [[nodiscard]] Origin origin_of(const std::string& key) const;
  /// Reads a file over it, or in place of nothing. From then on complaints are about that one.
  void read(const std::string& file);
  /// Applies `key.sub=value`. Throws ConfigError.
  void set(const std::string& set);
  /// The same error about the file and the key that the value came from; one about another file as it is.
  [[noreturn]] void fail(const ConfigError& error) const;

 private:
  [[nodiscard]] Origin place_of(const std::string& key) const;
  nlohmann::json& node_at(const std::string& path, const std::string& value, std::string& resolved);
  void merge(nlohmann::json& into, const std::string& key, const nlohmann::json& document,
             const Origin& origin);
  void replace(nlohmann::json& into, const std::string& key, nlohmann::json document, const Origin& origin);
  void remember(const nlohmann::json& node, const std::string& key, const Origin& origin);

  std::string file_;
  nlohmann::json value_ = nlohmann::json::object();
  std::map<std::string, Origin> origins_;  // of single values and of empty lists and sections
  std::map<std::string, Origin> marks_;
};

/// One strict JSON file. Throws ConfigError.
[[nodiscard]] nlohmann::json read_file(const std::string& file);

/// The base of the request, its file and its overrides. Throws ConfigError.
[[nodiscard]] Layers layers_of(const LoadRequest& request);

}  // namespace fathom::config

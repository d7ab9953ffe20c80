#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "blackbox/sample.hpp"

namespace fathom::blackbox {

/// How a service was started.
struct CommandLine {
  std::string executable;
  std::string folder;  ///< that relative paths count from
  std::vector<std::string> arguments;

  /// The value after an option; of several the last one.
  [[nodiscard]] std::optional<std::string> value_of(const std::string& option) const;
  /// The values of all.
  [[nodiscard]] std::vector<std::string> values_of(const std::string& option) const;
};

/// That of a process of this host. Nothing where it may not be seen, or is no service of this project.
[[nodiscard]] std::optional<CommandLine> command_line_of(std::uint32_t pid);

/// The recording that a process of this host has open; nothing where there is none, or where its files may
/// not be seen.
[[nodiscard]] std::optional<std::filesystem::path> recording_of(std::uint32_t pid);

/// As JSON: {"executable", "folder", "arguments": [...]}; and back.
[[nodiscard]] std::string to_json(const CommandLine& line);
[[nodiscard]] std::optional<CommandLine> command_line_from(std::string_view json);

/// What is kept of a service: its command line, its configuration file, the vehicle's file with the models of
/// the catalogue that it names, the files that a configuration refers to as parts of itself, its checkpoint.
/// Files that cannot be read, and those of more than 4 MB, are left out; so is whatever else a configuration
/// names: keys and tokens are nobody's business. The checkpoint is one that changes.
///   services/NAME/command.json, .../config.json, .../vehicle.json, .../catalogue/MODEL.json,
///   .../files/PATH, .../checkpoint
/// PATH is as the configuration says it, counted from the configuration's folder. `catalogue`: the folder of
/// models that do not lie beside the vehicle's file.
[[nodiscard]] std::vector<Enclosure> enclosures_of(const std::string& service, const CommandLine& line,
                                                   TimeNs now_ns, const std::string& catalogue = {});

/// Whether an enclosure's name, without services/NAME/, is that of the vehicle's file, of a model or of a
/// file that the configuration refers to; and where that has to lie, counted from the configuration's folder.
/// It is always inside of it.
[[nodiscard]] bool is_referred(std::string_view name);
[[nodiscard]] std::string referred_path(std::string_view name);

/// The content of a file that may be enclosed; nothing where it cannot be.
[[nodiscard]] std::optional<record::Bytes> read_enclosed(const std::string& path);

}  // namespace fathom::blackbox

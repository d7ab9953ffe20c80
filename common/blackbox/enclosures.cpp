#include "blackbox/enclosures.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "record/file.hpp"

namespace fathom::blackbox {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uint64_t kMostBytes = 4U << 20U;

std::optional<record::Bytes> read_small(const fs::path& path) {
  auto source = record::FileSource::open(path);
  if (!source || source.value()->size() > kMostBytes) return std::nullopt;
  record::Bytes bytes(source.value()->size());
  if (!source.value()->read(0, bytes).empty()) return std::nullopt;
  return bytes;
}

/// The text at a key of a configuration file and its overrides, e.g. "checkpoint.path"; empty when there is
/// none.
std::string text_at(const json& config, const CommandLine& line, const std::string& key) {
  std::string pointer = "/" + key;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  const json found = config.is_object() ? config.value(json::json_pointer(pointer), json()) : json();
  std::string text = found.is_string() ? found.get<std::string>() : std::string();
  for (const std::string& set : line.values_of("--set")) {
    if (set.starts_with(key + "=")) text = set.substr(key.size() + 1);
  }
  return text;
}

/// What names files that are parts of a configuration. Others it only mentions.
constexpr std::array<const char*, 1> kReferring{"engine.vehicle_model.coefficients_file"};
constexpr std::string_view kFiles = "files/";

/// Whether a path leads from a folder to something inside of it.
bool stays_inside(const fs::path& path) {
  return path.is_relative() && !path.empty() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
}

}  // namespace

std::vector<std::string> CommandLine::values_of(const std::string& option) const {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == option && i + 1 < arguments.size())
      out.push_back(arguments[++i]);
    else if (arguments[i].starts_with(option + "="))
      out.push_back(arguments[i].substr(option.size() + 1));
  }
  return out;
}

std::optional<std::string> CommandLine::value_of(const std::string& option) const {
  const std::vector<std::string> all = values_of(option);
  if (all.empty()) return std::nullopt;
  return all.back();
}

std::optional<fs::path> recording_of(std::uint32_t pid) {
  std::error_code failed;
  fs::directory_iterator at("/proc/" + std::to_string(pid) + "/fd", failed);
  for (; !failed && at != fs::directory_iterator(); at.increment(failed)) {
    std::error_code unreadable;
    fs::path file = fs::read_symlink(at->path(), unreadable);
    if (!unreadable && file.extension() == ".mcap") return file;
  }
  return std::nullopt;
}

std::optional<CommandLine> command_line_of(std::uint32_t pid) {
  const fs::path process = fs::path("/proc") / std::to_string(pid);
  std::error_code failed;
  CommandLine out;
  out.executable = fs::read_symlink(process / "exe", failed).string();
  // A life sign may name any process.
  if (failed || !fs::path(out.executable).filename().string().starts_with("fathom-")) return std::nullopt;
  out.folder = fs::read_symlink(process / "cwd", failed).string();
  std::ifstream file(process / "cmdline", std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\0', at), text.size());
    if (at > 0) out.arguments.push_back(text.substr(at, end - at));  // the first one is the executable
    at = end + 1;
  }
  return out;
}

std::string to_json(const CommandLine& line) {
  const json out = {{"executable", line.executable}, {"folder", line.folder}, {"arguments", line.arguments}};
  return out.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::optional<CommandLine> command_line_from(std::string_view text) {
  const json in = json::parse(text, nullptr, false);
  if (!in.is_object()) return std::nullopt;
  try {
    return CommandLine{in.at("executable"), in.at("folder"), in.at("arguments")};
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::vector<Enclosure> enclosures_of(const std::string& service, const CommandLine& line, TimeNs now_ns) {
  const std::string folder = "services/" + service + "/";
  const std::string command = to_json(line);
  std::vector<Enclosure> out{
      {folder + "command.json", "application/json", now_ns, {command.begin(), command.end()}}};
  const auto config = line.value_of("--config");
  if (!config) return out;
  const auto file = read_small(fs::path(line.folder) / *config);
  if (!file) return out;
  out.push_back({folder + "config.json", "application/json", now_ns, *file});
  const json read = json::parse(file->begin(), file->end(), nullptr, false);
  const fs::path place = (fs::path(line.folder) / *config).parent_path();
  for (const char* key : kReferring) {
    const fs::path path = text_at(read, line, key);
    if (!stays_inside(path)) continue;
    if (const auto part = read_small(place / path))
      out.push_back({folder + std::string(kFiles) + path.string(), "application/json", now_ns, *part});
  }
  const std::string checkpoint = text_at(read, line, "checkpoint.path");
  if (checkpoint.empty()) return out;
  out.push_back({folder + "checkpoint",
                 "application/octet-stream",
                 now_ns,
                 {},
                 (fs::path(line.folder) / checkpoint).string()});
  return out;
}

bool is_referred(std::string_view name) {
  return name.starts_with(kFiles) && stays_inside(name.substr(kFiles.size()));
}

std::string referred_path(std::string_view name) {
  return std::string(name.substr(kFiles.size()));
}

std::optional<record::Bytes> read_enclosed(const std::string& path) {
  return read_small(path);
}

}  // namespace fathom::blackbox

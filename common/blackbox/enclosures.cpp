#include "blackbox/enclosures.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>

#include "base/disk/folder.hpp"
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

/// Where the configuration of a service stands.
struct Files {
  fs::path own;      ///< its own file; empty: none
  fs::path vehicle;  ///< likewise the vehicle's
  std::string role;  ///< what kind of service it is, e.g. "fusion"
};

Files files_of(const CommandLine& line) {
  Files out;
  out.role = fs::path(line.executable).filename().string();
  if (out.role.starts_with("fathom-")) out.role = out.role.substr(7);
  std::replace(out.role.begin(), out.role.end(), '-', '_');
  const fs::path begin = line.folder;
  if (const auto own = line.value_of("--config")) out.own = begin / *own;
  if (const auto vehicle = line.value_of("--vehicle")) out.vehicle = begin / *vehicle;
  if (const auto folder = line.value_of("--folder")) {
    std::error_code failed;
    const fs::path both = begin / *folder;
    if (fs::exists(both / (out.role + ".json"), failed)) out.own = both / (out.role + ".json");
    if (fs::exists(both / "vehicle.json", failed)) out.vehicle = both / "vehicle.json";
  }
  return out;
}

/// The text at a key, e.g. "checkpoint.path", of the overrides, else of the first of these that has it; empty
/// when there is none.
std::string text_at(const std::vector<json>& configs, const CommandLine& line, const std::string& key) {
  std::string pointer = "/" + key;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  std::string text;
  for (auto config = configs.rbegin(); config != configs.rend(); ++config) {
    const json found = config->is_object() ? config->value(json::json_pointer(pointer), json()) : json();
    if (found.is_string()) text = found.get<std::string>();
  }
  for (const std::string& set : line.values_of("--set")) {
    if (set.starts_with(key + "=")) text = set.substr(key.size() + 1);
  }
  return text;
}

/// Models of the catalogue that the file of a vehicle names.
std::vector<std::string> models_of(const json& vehicle) {
  std::vector<std::string> out;
  const json instruments = vehicle.is_object() ? vehicle.value("instruments", json()) : json();
  for (const json& one : instruments.is_array() ? instruments : json::array()) {
    const json model = one.is_object() ? one.value("model", json()) : json();
    const std::string name = model.is_string() ? model.get<std::string>() : "";
    const bool plain = !name.empty() && name.find('/') == std::string::npos;
    if (plain && std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  }
  return out;
}

/// What names files that are parts of a configuration. Others it only mentions.
constexpr std::array<const char*, 1> kReferring{"engine.vehicle_model.coefficients_file"};
constexpr std::string_view kFiles = "files/";
constexpr const char* kVehicle = "vehicle.json";
constexpr std::string_view kCatalogue = "catalogue/";

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
  for (const fs::path& descriptor : paths_in("/proc/" + std::to_string(pid) + "/fd", failed)) {
    std::error_code unreadable;
    fs::path file = fs::read_symlink(descriptor, unreadable);
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

std::vector<Enclosure> enclosures_of(const std::string& service, const CommandLine& line, TimeNs now_ns,
                                     const std::string& catalogue) {
  const std::string folder = "services/" + service + "/";
  const std::string command = to_json(line);
  std::vector<Enclosure> out{
      {folder + "command.json", "application/json", now_ns, {command.begin(), command.end()}}};
  const auto enclose = [&](const std::string& name, const fs::path& path) {
    auto bytes = path.empty() ? std::nullopt : read_small(path);
    json read = bytes ? json::parse(bytes->begin(), bytes->end(), nullptr, false) : json();
    if (bytes) out.push_back({folder + name, "application/json", now_ns, std::move(*bytes)});
    return read;
  };
  const Files files = files_of(line);
  std::vector<json> said{enclose("config.json", files.own)};
  fs::path place = files.own.parent_path();
  const json vehicle = enclose(kVehicle, files.vehicle);
  if (!vehicle.is_null()) {
    if (place.empty()) place = files.vehicle.parent_path();
    for (const std::string& model : models_of(vehicle)) {
      const fs::path own = files.vehicle.parent_path() / "catalogue" / (model + ".json");
      std::error_code failed;
      enclose(std::string(kCatalogue) + model + ".json",
              fs::exists(own, failed) ? own : fs::path(catalogue) / (model + ".json"));
    }
    const json services = vehicle.is_object() ? vehicle.value("services", json()) : json();
    if (services.is_object()) said.push_back(services.value(files.role, json()));
  }
  if (out.size() == 1) return out;
  for (const char* key : kReferring) {
    const fs::path path = text_at(said, line, key);
    if (stays_inside(path)) enclose(std::string(kFiles) + path.string(), place / path);
  }
  std::string checkpoint = text_at(said, line, "checkpoint.path");
  if (checkpoint.empty() && !vehicle.is_null() && files.role == "fusion")
    checkpoint = "/run/fathom/" + service + ".checkpoint";  // as for a vehicle that says none
  if (checkpoint.empty()) return out;
  out.push_back({folder + "checkpoint",
                 "application/octet-stream",
                 now_ns,
                 {},
                 (fs::path(line.folder) / checkpoint).string()});
  return out;
}

bool is_referred(std::string_view name) {
  return name == kVehicle || (name.starts_with(kCatalogue) && stays_inside(name)) ||
         (name.starts_with(kFiles) && stays_inside(name.substr(kFiles.size())));
}

std::string referred_path(std::string_view name) {
  return std::string(name.starts_with(kFiles) ? name.substr(kFiles.size()) : name);
}

std::optional<record::Bytes> read_enclosed(const std::string& path) {
  return read_small(path);
}

}  // namespace fathom::blackbox

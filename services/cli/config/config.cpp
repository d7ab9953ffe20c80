#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/nearest.hpp"
#include "cli/command.hpp"
#include "config/vehicle/catalogue.hpp"
#include "config/vehicle/folder.hpp"
#include "config/vehicle/provenance.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::cli {
namespace {

struct ShowOptions {
  std::string service, vehicle, file, folder;
  std::vector<std::string> sets;
  bool json = false;
  bool said = false;
};

const config::ConfigKind& kind_of(const std::string& service) {
  const std::vector<std::string> known = config::all_services();
  for (const config::ConfigKind& kind : config::config_kinds()) {
    if (kind.name == service && std::find(known.begin(), known.end(), service) != known.end()) return kind;
  }
  const auto meant = nearest(service, known);
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
  throw Failure(ExitCode::bad_configuration, "config show: " + service + ": no such service; " +
                                                 (meant ? "nearest is " + *meant : "there are " + list));
}

// As people write it: fifteen degrees went through radians and came back as 14.999999999999998.
std::string text_of(const nlohmann::json& value) {
  if (value.is_array()) {
    std::string out;
    for (const auto& element : value) out += (out.empty() ? "" : ", ") + text_of(element);
    return "[" + out + "]";
  }
  if (!value.is_number_float()) return value.dump();
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.12g", value.get<double>());
  return text.data();
}

/// Where a value stands; nowhere, when it was said on the command line.
std::string file_of(const config::Origin& origin) {
  return origin.layer == config::Layer::command_line ? "" : origin.file;
}

void print_text(const std::vector<config::Provenance>& values) {
  std::size_t widest = 0;
  for (const auto& one : values) widest = std::max(widest, one.key.size());
  for (const auto& one : values) {
    std::string line = one.key + std::string(widest - one.key.size() + 2, ' ') + text_of(one.value);
    line += std::string(line.size() < widest + 30 ? widest + 30 - line.size() : 1, ' ');
    line += std::string(config::to_string(one.origin.layer));
    if (one.origin.layer == config::Layer::command_line) line += "  --set " + one.origin.key;
    if (const std::string file = file_of(one.origin); !file.empty())
      line += "  " + file + ": " + one.origin.key;
    std::printf("%s\n", line.c_str());
  }
}

void print_json(const ShowOptions& options, const std::vector<config::Provenance>& values) {
  nlohmann::ordered_json out;
  out["service"] = options.service;
  out["values"] = nlohmann::ordered_json::array();
  for (const auto& one : values) {
    out["values"].push_back({{"key", one.key},
                             {"value", one.value},
                             {"from", config::to_string(one.origin.layer)},
                             {"file", file_of(one.origin)},
                             {"file_key", one.origin.key}});
  }
  std::printf("%s\n", out.dump().c_str());
}

/// A service may be called as its program is: gps-bridge or fathom-gps-bridge for gps_bridge.
std::string service_named(std::string text) {
  constexpr std::string_view kProgram = "fathom-";
  if (text.starts_with(kProgram)) text.erase(0, kProgram.size());
  std::replace(text.begin(), text.end(), '-', '_');
  return text;
}

ExitCode run_show(ShowOptions options) {
  if (options.vehicle.empty() && options.file.empty() && options.folder.empty())
    throw Failure(ExitCode::bad_configuration,
                  "config show: --vehicle, --config or --folder is required; see --help");
  options.service = service_named(options.service);
  const config::ConfigKind& kind = kind_of(options.service);
  config::LoadRequest request{options.file, options.sets};
  if (!options.folder.empty())
    request = config::from_folder(std::move(request), options.folder, options.service);
  if (!options.vehicle.empty())
    request = config::with_vehicle(std::move(request), options.vehicle, options.service);
  std::vector<config::Provenance> values = config::provenance(kind, request);
  if (options.said) {
    std::erase_if(values, [](const auto& one) { return one.origin.layer == config::Layer::standard; });
  }
  if (options.json)
    print_json(options, values);
  else
    print_text(values);
  return ExitCode::done;
}

}  // namespace

void add_config(CLI::App& app, ExitCode& exit_code) {
  CLI::App* group = app.add_subcommand("config", "What services run with.");
  group->require_subcommand(1);
  auto options = std::make_shared<ShowOptions>();
  CLI::App* show = group->add_subcommand("show",
                                         "What a service would run with, and where each value came from: "
                                         "default, catalogue, vehicle, override, command line.");
  show->add_option("service", options->service, "e.g. fusion, imu_bridge, monitor")->required();
  CLI::Option* vehicle =
      show->add_option("--vehicle", options->vehicle, "file of the vehicle, e.g. /etc/fathom/vehicle.json");
  CLI::Option* own =
      show->add_option("--config", options->file, "the service's own file, which goes before the vehicle's");
  show->add_option("--folder", options->folder,
                   "a folder with both, e.g. /etc/fathom: vehicle.json, and SERVICE.json over it; as the "
                   "systemd units read it")
      ->excludes(vehicle)
      ->excludes(own);
  show->add_option("--set", options->sets, "override: key.sub=value, may be repeated")
      ->allow_extra_args(false);
  show->add_flag("--said", options->said, "only what somebody said: no defaults");
  show->add_flag("--json", options->json, "as JSON");
  show->callback([options, &exit_code] { exit_code = run_show(*options); });
}

}  // namespace fathom::cli

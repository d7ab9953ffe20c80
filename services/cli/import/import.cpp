#include "logs/import.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"
#include "dataset/dataset.hpp"

namespace fathom::cli {
namespace {

struct ImportOptions {
  std::string file;
  std::string out;
  std::vector<std::string> choices;
  std::string time = "boot";
  bool gzip = false;
  bool json = false;
};

const std::vector<std::string> kFiles{"imu", "gps", "airspeed", "baro", "mag"};

logs::ConvertOptions convert_options(const ImportOptions& options) {
  logs::ConvertOptions out;
  out.utc = options.time == "utc";
  for (const std::string& choice : options.choices) {
    const std::size_t equals = choice.find('=');
    const std::string file = choice.substr(0, equals);
    if (equals == std::string::npos || std::find(kFiles.begin(), kFiles.end(), file) == kFiles.end()) {
      throw Failure(
          ExitCode::bad_configuration,
          "--from " + choice + ": expected FILE=TOPIC:INSTANCE, FILE one of imu, gps, airspeed, baro, mag");
    }
    out.choice[file] = choice.substr(equals + 1);
  }
  return out;
}

std::string to_text(const ImportOptions& options, const logs::Log& log, const logs::Vehicle& vehicle) {
  std::string text = options.out + ": " + log.format + " " + options.file;
  for (const char* key : {"sys_name", "ver_hw", "firmware"}) {
    if (const auto found = log.info.find(key); found != log.info.end()) text += ", " + found->second;
  }
  text += "\n";
  const auto row = [&](const std::string& name, std::size_t rows) {
    if (rows == 0) return;
    const auto from = vehicle.sources.find(name);
    std::string line = "  " + name + ".csv";
    line.resize(std::max<std::size_t>(line.size(), 16), ' ');
    line += std::to_string(rows) + " rows";
    if (from != vehicle.sources.end()) line += " from " + from->second;
    if (const auto others = vehicle.others.find(name); others != vehicle.others.end()) {
      line += "; the log also has";
      for (const std::string& other : others->second) line += " " + other;
    }
    text += line + "\n";
  };
  for_each_kind([&](auto kind) {
    row(std::string(kind.kWord), vehicle.data.of<typename decltype(kind)::Sample>().size());
  });
  for (const logs::Table& table : vehicle.tables) row(table.name, table.stamps_ns.size());
  if (vehicle.utc_of_start_ns)
    text += "  the autopilot started at " + to_iso8601(*vehicle.utc_of_start_ns, 3) + " (GPS)\n";
  if (log.dropouts > 0 && log.dropout_ms == 0) {
    text += "  the logger dropped " + std::to_string(log.dropouts) + " messages\n";
  } else if (log.dropouts > 0) {
    text += "  the logger lost " + std::to_string(log.dropout_ms) + " ms in " + std::to_string(log.dropouts) +
            " dropouts\n";
  }
  for (const std::string& note : log.notes) text += "  " + note + "\n";
  for (const std::string& note : vehicle.notes) text += "  " + note + "\n";
  constexpr std::size_t kShown = 5;
  for (std::size_t i = 0; i < std::min(kShown, log.losses.listed.size()); ++i) {
    const logs::Lost& lost = log.losses.listed[i];
    text += "  offset " + std::to_string(lost.offset) + ": lost " + std::to_string(lost.bytes) +
            " bytes: " + lost.what + "\n";
  }
  if (log.losses.count > kShown) {
    text += "  in all " + std::to_string(log.losses.count) + " losses, " + std::to_string(log.losses.bytes) +
            " bytes; import.json lists the first " + std::to_string(log.losses.listed.size()) + "\n";
  }
  return text;
}

void import(const ImportOptions& options) {
  const logs::ConvertOptions convert = convert_options(options);
  try {
    const logs::Log log = logs::read(options.file);
    logs::Vehicle vehicle;
    try {
      vehicle = logs::convert(log, convert);
    } catch (const logs::LogError& error) {
      throw Failure(ExitCode::bad_input, options.file + ": " + error.what());
    }
    logs::write(options.out, options.file, log, vehicle, {options.gzip});
    const std::string answer =
        options.json ? logs::to_json(options.file, log, vehicle) : to_text(options, log, vehicle);
    std::fputs(answer.c_str(), stdout);
    if (vehicle.data.of<ImuSample>().empty())
      std::fputs("fathom: no inertial samples: the data set is not for solve\n", stderr);
  } catch (const logs::LogError& error) {
    throw Failure(ExitCode::bad_input, error.what());
  } catch (const dataset::DatasetError& error) {
    throw Failure(ExitCode::runtime_failure, error.what());
  }
}

}  // namespace

void add_import(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<ImportOptions>();
  CLI::App* command =
      app.add_subcommand("import", "Makes a data set of the flight log of another autopilot.");
  command->footer(
      "Reads PX4 ULog (.ulg) and ArduPilot DataFlash (.bin); the first bytes tell which. Damaged and cut\n"
      "files are read as far as they are good; what was lost is said. common/logs/README.md, installed as\n"
      "flight-logs.md, tells which message becomes what.");
  command->add_option("file", options->file, "the log")->required();
  command->add_option("--out", options->out, "folder to write; created when absent")->required();
  command
      ->add_option("--from", options->choices,
                   "FILE=TOPIC:INSTANCE: what a file is made from where the log has several, e.g. "
                   "imu=vehicle_imu:1 or gps=GPS:1; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--time", options->time,
                   "\"boot\": t_s counts from the autopilot's start; \"utc\": from 2020-01-01 UTC, by GPS")
      ->check(CLI::IsMember({"boot", "utc"}))
      ->capture_default_str();
  command->add_flag("--gzip", options->gzip, "write .csv.gz");
  command->add_flag("--json", options->json, "print import.json");
  command->callback([options] { import(*options); });
}

}  // namespace fathom::cli

#include "logs/import.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/units.hpp"
#include "cli/command.hpp"
#include "cli/outputs.hpp"
#include "cli/removed_files.hpp"
#include "dataset/dataset.hpp"
#include "logs/ros2/reader.hpp"

namespace fathom::cli {
namespace {

struct ImportOptions {
  std::string file;
  std::string out;
  std::vector<std::string> choices;
  std::vector<std::string> axes;
  std::vector<std::string> mountings;
  logs::Ros2Options ros2;
  std::string time = "boot";
  bool gzip = false;
  bool json = false;
};

/// What a choice may be of: files of the data set, and a velocity that stands in one of them.
std::vector<std::string> choosable() {
  std::vector<std::string> out;
  for_each_kind([&](auto kind) { out.emplace_back(kind.kWord); });
  out.insert(out.end(), {"baro", "mag", "gps_velocity"});
  return out;
}

/// "left=right"; the option's name and what is expected are for the refusal.
std::pair<std::string, std::string> halves(std::string_view option, const std::string& text,
                                           std::string_view expected) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw Failure(ExitCode::bad_configuration,
                  std::string(option) + " " + text + ": expected " + std::string(expected));
  return {text.substr(0, equals), text.substr(equals + 1)};
}

logs::Ros2Options ros2_options(const ImportOptions& options) {
  logs::Ros2Options out = options.ros2;
  for (const std::string& one : options.axes) {
    constexpr std::string_view kExpected = "TOPIC=flu or TOPIC=frd";
    const auto [topic, axes] = halves("--axes", one, kExpected);
    if (axes != "flu" && axes != "frd")
      throw Failure(ExitCode::bad_configuration, "--axes " + one + ": expected " + std::string(kExpected));
    out.axes[topic] = axes == "frd" ? logs::Ros2Options::Axes::frd : logs::Ros2Options::Axes::flu;
  }
  for (const std::string& one : options.mountings) {
    constexpr std::string_view kExpected = "FRAME=ROLL,PITCH,YAW in degrees, e.g. dvl_link=0,0,45";
    const auto [frame, angles] = halves("--mounting", one, kExpected);
    std::istringstream in(angles);
    std::array<double, 3> rpy_deg{};
    char comma = ',';
    bool sound = true;
    for (std::size_t i = 0; i < rpy_deg.size(); ++i) {
      if (i > 0) sound = sound && in >> comma && comma == ',';
      sound = sound && in >> rpy_deg[i] && rpy_deg[i] >= -360.0 && rpy_deg[i] <= 360.0;
    }
    if (!sound || in.peek() != std::istringstream::traits_type::eof())
      throw Failure(ExitCode::bad_configuration,
                    "--mounting " + one + ": expected " + std::string(kExpected));
    for (double& angle : rpy_deg) angle *= kRadPerDeg;
    out.mounting_rpy_rad[frame] = rpy_deg;
  }
  return out;
}

logs::ConvertOptions convert_options(const ImportOptions& options) {
  logs::ConvertOptions out;
  out.utc = options.time == "utc";
  out.ros2 = ros2_options(options);
  const std::vector<std::string> known = choosable();
  std::string files;
  for (const std::string& file : known) files += (files.empty() ? "" : ", ") + file;
  const std::string expected = "FILE=TOPIC or FILE=TOPIC:INSTANCE, FILE one of " + files;
  for (const std::string& choice : options.choices) {
    const auto [file, topic] = halves("--from", choice, expected);
    if (std::find(known.begin(), known.end(), file) == known.end())
      throw Failure(ExitCode::bad_configuration, "--from " + choice + ": expected " + expected);
    out.choice[file] = topic;
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
    text += "  t_s = 0 of the log was " + to_iso8601(*vehicle.utc_of_start_ns, 3) + "\n";
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
    text += (lost.offset ? "  offset " + std::to_string(*lost.offset) + ": lost " : std::string("  lost ")) +
            (lost.bytes > 0 ? std::to_string(lost.bytes) + " bytes: " : std::string("some: ")) + lost.what +
            "\n";
  }
  if (log.losses.count > kShown) {
    text += "  in all " + std::to_string(log.losses.count) + " losses, " + std::to_string(log.losses.bytes) +
            " bytes; import.json lists the first " + std::to_string(log.losses.listed.size()) + "\n";
  }
  return text;
}

/// Whether somebody gave an option that only a bag of ROS 2 is read by; its name.
std::string ros2_option(const CLI::App& command) {
  for (const char* name : {"--axes", "--mounting", "--base", "--surface-pressure", "--water-density"})
    if (command.count(name) > 0) return name;
  return "";
}

void import(const ImportOptions& options, const std::string& only_ros2) {
  const logs::ConvertOptions convert = convert_options(options);
  try {
    const logs::Log log = logs::read(options.file);
    if (!only_ros2.empty() && log.format != logs::ros2::kFormatName)
      throw Failure(ExitCode::bad_configuration,
                    only_ros2 + ": is for bags of ROS 2, " + options.file + " is of " + log.format);
    logs::Vehicle vehicle;
    try {
      vehicle = logs::convert(log, convert);
    } catch (const logs::LogError& error) {
      throw Failure(ExitCode::bad_input, options.file + ": " + error.what());
    }
    const RemovedFiles removed(options.out);
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
      app.add_subcommand("import", "Makes a data set of the log of another autopilot or of ROS 2.");
  command->footer(
      "Reads PX4 ULog (.ulg), ArduPilot DataFlash (.bin) and bags of ROS 2 (.mcap); the first bytes tell "
      "which.\n"
      "Damaged and cut files are read as far as they are good; what was lost is said. "
      "common/logs/README.md\n"
      "of the documents (/usr/share/doc/fathom) tells which message becomes what.");
  command->add_option("file", options->file, "the log; of ROS 2 also the folder of a bag")->required();
  command
      ->add_option("--out", options->out,
                   "folder to write; created when absent; files of an earlier data set there are removed")
      ->required();
  command
      ->add_option("--from", options->choices,
                   "FILE=TOPIC:INSTANCE: what a file is made from where the log has several, e.g. "
                   "imu=vehicle_imu:1, gps=GPS:1 or dvl=/odometry; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--time", options->time,
          "\"boot\": t_s counts from the start of the log; \"utc\": from 2020-01-01 UTC, by GPS, in ROS 2 "
          "by the stamps")
      ->check(CLI::IsMember({"boot", "utc"}))
      ->capture_default_str();
  command
      ->add_option("--axes", options->axes,
                   "ROS 2: TOPIC=flu or TOPIC=frd: its axes, forward-left-up and east-north-up, or "
                   "forward-right-down and "
                   "north-east-down; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--mounting", options->mountings,
          "ROS 2: FRAME=ROLL,PITCH,YAW: attitude of a sensor in the vehicle, degrees, forward-right-down, "
          "instead of tf_static's; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--base", options->ros2.base, "ROS 2: the frame of the vehicle in tf_static")
      ->capture_default_str();
  command
      ->add_option("--surface-pressure", options->ros2.surface_pressure_Pa,
                   "ROS 2: Pa, for depths of pressures in water")
      ->check(CLI::Range(50'000.0, 110'000.0))
      ->capture_default_str();
  command->add_option("--water-density", options->ros2.water_density_kg_m3, "ROS 2: kg/m3, likewise")
      ->check(CLI::Range(900.0, 1100.0))
      ->capture_default_str();
  command->add_flag("--gzip", options->gzip, "write .csv.gz");
  command->add_flag("--json", options->json, "print import.json");
  command->callback([options, command] {
    refuse_same_files({{"the input", options->file}}, {{"--out", options->out, true}});
    import(*options, ros2_option(*command));
  });
}

}  // namespace fathom::cli

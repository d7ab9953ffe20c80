#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/is_name.hpp"
#include "cli/command.hpp"
#include "cli/init/listening.hpp"
#include "config/json/error.hpp"
#include "config/vehicle/vehicle_config.hpp"

namespace fathom::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InitOptions {
  std::vector<std::string> serial, tcp, udp;
  std::string out = "vehicle.json";
  std::string name = "auv";
  std::optional<double> latitude_deg;
  double seconds = 60.0;
  bool yes = false;
  bool force = false;
};

/// What a person answers; nothing where the line is empty or there is none.
std::string answer(const std::string& question) {
  std::printf("%s ", question.c_str());
  std::fflush(stdout);
  std::string line;
  if (!std::getline(std::cin, line)) std::printf("\n");
  return line;
}

/// Three numbers. Asks again where it is something else.
void ask_three(const std::string& question, Json& value) {
  for (;;) {
    const std::string line = answer(question + " " + value.dump() + ":");
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    std::istringstream in(line);
    std::array<double, 3> numbers{};
    std::string more;
    if (in >> numbers[0] >> numbers[1] >> numbers[2] && !(in >> more)) {
      value = numbers;
      return;
    }
    std::printf("expected three numbers with spaces between them, e.g. 0.5 0 -0.2, or nothing to leave it\n");
  }
}

void ask_latitude(std::optional<double>& latitude_deg) {
  for (;;) {
    const std::string line =
        answer("Latitude of the area of operation, degrees, for gravity where a pressure becomes a depth:");
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    std::istringstream in(line);
    double value = 0.0;
    std::string more;
    if (in >> value && !(in >> more) && std::abs(value) <= 90.0) {
      latitude_deg = value;
      return;
    }
    std::printf("expected a number from -90 to 90, e.g. 36.4, or nothing\n");
  }
}

void ask(std::vector<Proposal>& proposals, InitOptions& options) {
  for (;;) {
    const std::string name = answer("Name of the vehicle [" + options.name + "]:");
    if (name.empty()) break;
    if (is_name(name)) {
      options.name = name;
      break;
    }
    std::printf("expected %s\n", kNameForm);
  }
  for (Proposal& one : proposals) {
    const std::string name = one.instrument["name"];
    if (one.has_place)
      ask_three("Where is " + name + "? metres forward, right, down of any one point of the vehicle",
                one.instrument["position_m"]);
    if (one.has_mounting)
      ask_three("Which way round is " + name + "? roll, pitch, yaw of its axes in the vehicle, degrees",
                one.instrument["mounting_rpy_deg"]);
    if (one.instrument["kind"] == "depth" && !options.latitude_deg) ask_latitude(options.latitude_deg);
  }
}

void report(const std::vector<Heard>& heard, const std::vector<Proposal>& proposals) {
  for (const Proposal& one : proposals) {
    std::printf("%s\n", one.what.c_str());
    for (const std::string& note : one.notes) std::printf("    %s\n", note.c_str());
  }
  for (const Heard& one : heard) {
    if (one.recognition) continue;
    const std::string port = runtime::describe_source(one.port);
    if (one.bytes == 0 && !one.trouble.empty())
      std::printf("%s\n", one.trouble.c_str());
    else if (one.bytes == 0)
      std::printf("%s: nothing was heard; is it there, has it power, does it speak without being asked?\n",
                  port.c_str());
    else
      std::printf("%s: %llu bytes that no codec understands; fathom decode --list names what there is\n",
                  port.c_str(), static_cast<unsigned long long>(one.bytes));
  }
}

/// As people write it: an array of numbers on one line.
std::string text_of(const Json& vehicle) {
  const std::string text = vehicle.dump(2) + "\n";
  std::string out;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"' && (i == 0 || text[i - 1] != '\\')) quoted = !quoted;
    const std::size_t end = text.find_first_of("]{\"", i + 1);
    if (quoted || text[i] != '[' || end == std::string::npos || text[end] != ']') {
      out += text[i];
      continue;
    }
    out += '[';
    for (++i; i < end; ++i) {
      if (text[i] == ',')
        out += ", ";
      else if (text[i] != '\n' && text[i] != ' ')
        out += text[i];
    }
    out += ']';
  }
  return out;
}

/// What is wrong with it; written beside its place for that, and left there where nothing is.
std::optional<config::ConfigError> complaint_of(const std::string& beside, const Json& vehicle) {
  write_text(beside, text_of(vehicle));
  try {
    config::vehicle_kind().check({beside, {}});
  } catch (const config::ConfigError& error) {
    std::filesystem::remove(beside);
    return error;
  }
  return std::nullopt;
}

/// An instrument that cannot be read yet, as a modem whose beacons nobody knows, is left out until somebody
/// says what is missing.
void leave_out_what_is_not_complete(const std::string& beside, Json& vehicle) {
  Json& instruments = vehicle["instruments"];
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    Json& one = instruments[i];
    if (one["kind"] == "imu") continue;
    Json alone = vehicle;
    for (std::size_t k = 0; k < instruments.size(); ++k)
      alone["instruments"][k]["enabled"] =
          k == i || instruments[k]["kind"] == "imu" || instruments[k]["name"] == one["name"];
    const auto complaint = complaint_of(beside, alone);
    if (!complaint) continue;
    one["enabled"] = false;
    const std::string key = complaint->key();
    std::printf("%s is written with \"enabled\": false until %s is said: %s\n",
                one["name"].get<std::string>().c_str(), key.c_str(), complaint->expectation().c_str());
  }
}

void write_vehicle(const std::string& path, Json vehicle) {
  const std::string beside = path + ".new";
  leave_out_what_is_not_complete(beside, vehicle);
  if (const auto complaint = complaint_of(beside, vehicle))
    throw Failure(ExitCode::bad_configuration,
                  std::string("init: what was found makes no vehicle: ") + complaint->what());
  std::error_code error;
  std::filesystem::rename(beside, path, error);
  if (error) throw Failure(ExitCode::runtime_failure, path + ": cannot be replaced: " + error.message());
}

std::vector<PortToHear> ports_of(const InitOptions& options) {
  std::vector<PortToHear> ports;
  for (const std::string& text : options.serial) ports.push_back(serial_port(text));
  for (const std::string& text : options.tcp) ports.push_back(tcp_port(text));
  for (const std::string& text : options.udp) ports.push_back(udp_port(text));
  if (ports.empty()) ports = serial_ports_here();
  if (ports.empty())
    throw Failure(
        ExitCode::bad_configuration,
        "init: this host has no serial port (ttyUSB, ttyACM, ttyAMA); name what to listen to with --serial, "
        "--tcp or --udp");
  return ports;
}

ExitCode run_init(InitOptions options) {
  const std::vector<PortToHear> ports = ports_of(options);
  if (std::filesystem::exists(options.out) && !options.force)
    throw Failure(
        ExitCode::bad_configuration,
        options.out +
            ": is there already, expected a new file; --out names another one, --force replaces it");
  if (!is_name(options.name))
    throw Failure(ExitCode::bad_configuration, "init: --name " + options.name + ": expected " + kNameForm);
  write_text(options.out + ".new", "");  // what cannot be written is better known before
  std::filesystem::remove(options.out + ".new");
  refuse_ports_in_use(ports);
  if (ports.size() == 1)
    std::printf("Listening to 1 port for up to %.0f s, writing nothing ...\n", options.seconds);
  else
    std::printf("Listening to %zu ports for up to %.0f s, writing to none ...\n", ports.size(),
                options.seconds);
  std::fflush(stdout);
  const SystemClock clock;
  const std::vector<Heard> heard = listen(ports, options.seconds, clock);
  std::vector<Proposal> proposals = propose(heard);
  report(heard, proposals);
  bool inertial = false;
  for (const Proposal& one : proposals) {
    inertial = inertial || one.instrument["kind"] == "imu";
  }
  if (!inertial) {
    std::fprintf(stderr,
                 "fathom: init: no inertial unit was recognised, and without one nothing navigates; %s is "
                 "not written\n",
                 options.out.c_str());
    return ExitCode::no;
  }
  for (const Heard& one : heard) {
    if (!options.latitude_deg && one.recognition && one.recognition->latitude_rad)
      options.latitude_deg = std::round(*one.recognition->latitude_rad * 1800.0 / std::numbers::pi) / 10.0;
  }
  if (!options.yes) ask(proposals, options);
  Json vehicle;
  vehicle["name"] = options.name;
  if (options.latitude_deg) vehicle["latitude_deg"] = *options.latitude_deg;
  vehicle["instruments"] = Json::array();
  for (const Proposal& one : proposals) vehicle["instruments"].push_back(one.instrument);
  write_vehicle(options.out, vehicle);
  std::printf(
      "%s is written.%s\nNext: fathom config show fusion --vehicle %s\n", options.out.c_str(),
      options.yes
          ? " Where the instruments are was not asked: position_m and mounting_rpy_deg have to be checked."
          : "",
      options.out.c_str());
  return ExitCode::done;
}

}  // namespace

void add_init(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<InitOptions>();
  CLI::App* command = app.add_subcommand("init",
                                         "Listens to ports, recognises the instruments there, and writes the "
                                         "vehicle's file. Writes to no device.");
  command
      ->add_option("--serial", options->serial,
                   "serial port, PATH or PATH@BAUD; without a rate all usual ones are tried; may be "
                   "repeated; without any "
                   "port all of ttyUSB, ttyACM and ttyAMA")
      ->allow_extra_args(false);
  command->add_option("--tcp", options->tcp, "device that serves TCP, ADDRESS:PORT; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--udp", options->udp,
                   "port of this host that datagrams come to, PORT or ADDRESS:PORT; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--seconds", options->seconds, "listen for at most this long")
      ->check(CLI::Range(1.0, 3600.0));
  command
      ->add_option("--latitude", options->latitude_deg,
                   "of the area of operation, degrees; else of a fix that is heard")
      ->check(CLI::Range(-90.0, 90.0));
  command->add_option("--name", options->name, "of the vehicle");
  command->add_option("--out", options->out, "the file");
  command->add_flag("--yes", options->yes, "ask nothing: places are written as zero, and have to be checked");
  command->add_flag("--force", options->force, "replace the file");
  command->callback([options, &exit_code] { exit_code = run_init(*options); });
}

}  // namespace fathom::cli

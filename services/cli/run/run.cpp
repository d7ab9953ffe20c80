#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "base/clock.hpp"
#include "cli/command.hpp"
#include "cli/listed.hpp"
#include "cli/run/plan.hpp"
#include "launch/check.hpp"
#include "launch/executable.hpp"
#include "launch/supervisor.hpp"

namespace fathom::cli {
namespace {

// A service that cannot go on for now (a card without a link, say) is tried again at this pace.
constexpr DurationNs kRunRestartAfterNs = 2 * kNsPerSecond;
// As long as systemd waits for a life sign (WatchdogSec of its unit). They come once a second.
constexpr DurationNs kRunSilenceNs = 10 * kNsPerSecond;
// As long as systemd leaves a service (TimeoutStopSec of its unit).
constexpr DurationNs kRunStopGraceNs = 5 * kNsPerSecond;

std::atomic<bool> run_stop_requested{false};

/// The first one ends the run in order. Who presses Ctrl-C again waits no longer: the kernel kills the
/// services of a parent that is gone.
extern "C" void request_run_stop(int signal) {
  if (run_stop_requested && signal == SIGINT) _exit(static_cast<int>(ExitCode::runtime_failure));
  run_stop_requested = true;
}

void catch_stop_signals() {
  std::signal(SIGINT, request_run_stop);
  std::signal(SIGTERM, request_run_stop);
  // Ignored by whoever started it (nohup), it stays so.
  if (std::signal(SIGHUP, request_run_stop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

/// Where logs and what the services write go: the given folder, or a new one.
class RunFolder {
 public:
  explicit RunFolder(const std::string& given) {
    namespace fs = std::filesystem;
    if (!given.empty()) {
      path_ = fs::absolute(given);
      std::error_code error;
      fs::create_directories(path_, error);
      if (access(path_.c_str(), W_OK | X_OK) != 0)
        throw Failure(ExitCode::bad_configuration,
                      "run: --logs " + given + ": cannot be written to: " +
                          (error ? error : std::error_code(errno, std::generic_category())).message());
      return;
    }
    const char* state = std::getenv("XDG_STATE_HOME");
    const bool has_state = state != nullptr && fs::path(state).is_absolute();
    const fs::path base = has_state ? fs::path(state) / "fathom" : fs::temp_directory_path();
    std::error_code error;  // the next line says it
    fs::create_directories(base, error);
    std::string pattern = (base / (has_state ? "run-XXXXXX" : "fathom-run-XXXXXX")).string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw Failure(ExitCode::runtime_failure,
                    "run: " + base.string() + ": no folder for the logs can be made there, see --logs: " +
                        std::error_code(errno, std::generic_category()).message());
    path_ = pattern;
    is_new_ = true;
  }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Nothing was started: a folder that nobody asked for goes again.
  void give_up() const {
    std::error_code ignored;
    if (is_new_) std::filesystem::remove(path_, ignored);
  }

 private:
  std::filesystem::path path_;
  bool is_new_ = false;
};

void tell(const std::string& line) {
  std::cout << line << std::endl;
}

/// The last line of a log: why a service ended.
std::string last_line_of(const std::filesystem::path& log) {
  std::ifstream in(log);
  std::string last;
  for (std::string line; std::getline(in, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

/// The services that are to run, when none of them has anything against its configuration.
std::vector<launch::Program> checked_programs(const RunPlan& plan) {
  std::vector<launch::Program> out;
  for (const RunService& one : plan.services) {
    if (access(one.program.executable.c_str(), X_OK) != 0)
      throw Failure(ExitCode::bad_configuration, one.program.executable.string() +
                                                     ": cannot be run, and the vehicle needs " +
                                                     one.program.name + "; --without leaves it out");
    out.push_back(one.program);
  }
  const auto complaints = launch::complaints_of(out);
  for (const launch::Complaint& one : complaints)
    std::fprintf(stderr, "fathom: %s: %s\n", listed(one.names).c_str(), one.text.c_str());
  if (!complaints.empty()) out.clear();
  return out;
}

void introduce(const RunPlan& plan, const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const RunService& one : plan.services) names.push_back(one.program.name);
  const std::string console = console_address(plan);
  tell(plan.vehicle + " runs: " + listed(names) + "; logs in " + folder.string() +
       (console.empty() ? "" : "; console at " + console));
  tell("`" + status_command(plan) + "` says how it goes. Ctrl-C ends it.");
}

struct RunCommand {
  RunRequest request;
  std::string logs;
};

ExitCode run_vehicle(RunCommand command) {
  const RunFolder folder(command.logs);
  RunRequest& request = command.request;
  request.folder = folder.path();
  request.executables = launch::executables_folder();
  RunPlan plan;
  std::vector<launch::Program> programs;
  try {
    plan = plan_run(request);
    programs = checked_programs(plan);
  } catch (...) {
    folder.give_up();
    throw;
  }
  if (programs.empty()) {
    folder.give_up();
    return ExitCode::bad_configuration;
  }

  catch_stop_signals();
  launch::Supervisor supervisor(folder.path(), kRunRestartAfterNs, kRunSilenceNs);
  for (const launch::Program& program : programs) supervisor.start(program);
  introduce(plan, folder.path());
  const SystemClock clock;
  while (!run_stop_requested && !supervisor.gave_up()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    for (const std::string& line : supervisor.poll(clock.monotonic_ns())) {
      tell(line);
      if (line.find("refused its configuration") == std::string::npos) continue;
      tell("  " + last_line_of(supervisor.log_of(line.substr(0, line.find(' ')))));
    }
  }
  for (const std::string& name : supervisor.stop(kRunStopGraceNs))
    tell(name + " did not end when asked, and was killed");
  if (supervisor.gave_up()) return ExitCode::bad_configuration;
  tell("All services have ended.");
  return ExitCode::done;
}

}  // namespace

void add_run(CLI::App& app, ExitCode& exit_code) {
  auto command = std::make_shared<RunCommand>();
  CLI::App* run = app.add_subcommand(
      "run",
      "Runs a vehicle on this machine without systemd: fusion, monitor, console, the bridges of its "
      "instruments, and the services that its file names. Ctrl-C ends them all.");
  run->footer(
      "Every configuration is checked first; with any complaint nothing starts. A service that ends, "
      "or gives no life sign for 10 s, is started again.\nExit code: 0 ended by Ctrl-C or SIGTERM, 2 a "
      "configuration was refused. A second "
      "Ctrl-C ends at once.");
  RunRequest& request = command->request;
  run->add_option("vehicle", request.vehicle, "file of the vehicle, e.g. vehicle.json")->required();
  run->add_option("--without", request.without,
                  "a service that is left out, or one of several fusions by its name; may be repeated")
      ->allow_extra_args(false);
  run->add_option("--record", request.record, "run the recorder as well, and record into this folder");
  run->add_option("--logs", command->logs,
                  "folder of the logs, one a service, and of checkpoint and journal where the vehicle does "
                  "not say another place; else a new one in $XDG_STATE_HOME/fathom or the system's temporary "
                  "folder");
  run->add_option("--set", request.sets,
                  "override: bus.domain=3 of every service (vehicle, bus, log, clock, realtime), "
                  "fusion.checkpoint.period_s=2 of one; may be repeated")
      ->allow_extra_args(false);
  run->callback([command, &exit_code] { exit_code = run_vehicle(*command); });
}

}  // namespace fathom::cli

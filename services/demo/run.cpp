#include "demo/run.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <thread>

#include <unistd.h>

#include "base/clock.hpp"
#include "bus/participant.hpp"
#include "demo/observer.hpp"
#include "demo/plan.hpp"

namespace fathom::demo {
namespace {

// A service that died stays away this long, so that the monitor is seen to say who is missing.
constexpr DurationNs kRestartAfterNs = 6 * kNsPerSecond;
constexpr DurationNs kStopGraceNs = 5 * kNsPerSecond;

std::atomic<bool> stop_requested{false};
extern "C" void request_stop(int) {
  stop_requested = true;
}

/// A folder below the system's temporary one that is removed at the end, unless something is to be looked up
/// in it.
class RunDirectory {
 public:
  RunDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fathom-demo-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot create " + pattern);
    path_ = pattern;
    std::filesystem::create_directory(path_ / "devices");
  }
  ~RunDirectory() {
    std::error_code ignored;
    if (!keep_) std::filesystem::remove_all(path_, ignored);
  }
  RunDirectory(const RunDirectory&) = delete;
  RunDirectory& operator=(const RunDirectory&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  void keep() { keep_ = true; }

 private:
  std::filesystem::path path_;
  bool keep_ = false;
};

void say(const std::string& line) {
  std::cout << line << std::endl;
}

void say_new_alarms(const Observation& seen, std::map<std::string, bool>& said) {
  for (const auto& [name, alarm] : seen.alarms) {
    const auto at = said.find(name);
    if (at != said.end() && at->second == alarm.active) continue;
    if (at == said.end() && !alarm.active) continue;
    said[name] = alarm.active;
    say(std::string("        ") + (alarm.active ? "ALARM  " : "over   ") + alarm.text);
  }
}

void say_summary(const Plan& plan, const std::vector<Finding>& findings) {
  say("");
  say("Summary of " + plan.title);
  for (const Finding& finding : findings)
    say(std::string(finding.met ? "  met      " : "  NOT MET  ") + finding.text);
}

/// The file that was written last; empty when there is none.
std::string newest_recording(const std::filesystem::path& folder) {
  std::filesystem::path newest;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    if (entry.path().extension() == ".mcap" && entry.path() > newest) newest = entry.path();
  }
  return newest.string();
}

volatile std::sig_atomic_t last_code = 0;

/// All is said; what is left is to leave the vehicle network. Should the bus not let go, the answer still
/// comes.
void leave_in_time(ExitCode code) {
  constexpr unsigned kPatienceS = 20;
  last_code = static_cast<int>(code);
  std::signal(SIGALRM, [](int) { _exit(last_code); });
  alarm(kPatienceS);
}

/// As a word of a shell's command line.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// One line per service, name and command, for whoever wants to run them by hand or on several machines.
void write_commands(const Plan& plan, const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const launch::Program& program : plan.programs) {
    out << program.name << '\t' << quoted(program.executable.string());
    for (const std::string& argument : program.arguments) out << ' ' << quoted(argument);
    out << '\n';
  }
  if (!out.flush()) throw std::runtime_error(file.string() + ": cannot be written");
}

}  // namespace

ExitCode run(const Options& options) {
  std::signal(SIGINT, request_stop);
  std::signal(SIGTERM, request_stop);
  std::signal(SIGHUP, request_stop);
  std::signal(SIGPIPE, SIG_IGN);

  if (!options.commands.empty()) {
    const std::filesystem::path folder = std::filesystem::absolute(options.commands);
    write_commands(make_plan(options, folder), folder / "commands.txt");
    return ExitCode::done;
  }
  RunDirectory directory;
  Plan plan = make_plan(options, directory.path());
  std::unique_ptr<Clock> clock;
  if (plan.epoch_ns == 0) {
    clock = std::make_unique<SystemClock>();
  } else {
    clock = std::make_unique<ScaledClock>(plan.epoch_ns, options.speed);
  }

  // The observer first: it must not miss the first navigation state.
  bus::ParticipantOptions presence;
  presence.name = "demo";
  presence.low_priority = true;
  presence.domain = static_cast<std::uint32_t>(options.domain);
  presence.interfaces = options.interfaces;
  presence.peers = options.peers;
  presence.security = {plan.credentials, "cli"};
  bus::Participant participant(presence);
  Observer observer(participant, *clock, plan.record);
  launch::Supervisor supervisor(directory.path(), kRestartAfterNs);
  say("Starting " + plan.title + ": " + std::to_string(plan.programs.size()) + " services on DDS domain " +
      std::to_string(options.domain) + ", logs in " + directory.path().string());
  if (!plan.credentials.empty()) {
    say("Protected: look with FATHOM_SECURITY_DIR=" + plan.credentials + " fathom status --domain " +
        std::to_string(options.domain));
  }
  for (const launch::Program& program : plan.programs) supervisor.start(program);
  if (!plan.console.empty()) say("Console: " + plan.console);

  const SystemClock host;
  const TimeNs began_ns = clock->monotonic_ns();
  TimeNs next_line_ns = host.monotonic_ns() + kNsPerSecond;
  std::map<std::string, bool> alarms_said;
  const auto elapsed_s = [&] { return to_seconds(clock->monotonic_ns() - began_ns); };
  while (!stop_requested && !supervisor.gave_up() && elapsed_s() < plan.duration_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    for (const std::string& line : supervisor.poll(host.monotonic_ns())) say("        " + line);
    if (host.monotonic_ns() < next_line_ns) continue;
    next_line_ns += kNsPerSecond;
    const Observation seen = observer.look();
    say_new_alarms(seen, alarms_said);
    say(status_line(elapsed_s(), seen));
  }

  const double duration_s = elapsed_s();
  const Observation seen = observer.look();
  plan.demands.whole_run = plan.demands.whole_run && !stop_requested;
  plan.demands.restarts = supervisor.restarts();
  plan.demands.killed = supervisor.stop(kStopGraceNs);
  const std::vector<Finding> findings = judge(seen, plan.demands);
  say_summary(plan, findings);
  const std::string recording = newest_recording(plan.recordings);
  if (!recording.empty()) say("Recording: " + recording);
  bool good = true;
  for (const Finding& finding : findings) good = good && finding.met;
  if (!options.report.empty()) {
    std::ofstream out(options.report);
    out << report_json(plan.title, duration_s, seen, plan.demands, findings, recording);
    if (!out.flush()) throw std::runtime_error(options.report + ": cannot be written");
  }
  if (!good) {
    directory.keep();
    say("Logs are kept in " + directory.path().string());
  }
  const ExitCode code = good ? ExitCode::done : ExitCode::no;
  leave_in_time(code);
  return code;
}

}  // namespace fathom::demo

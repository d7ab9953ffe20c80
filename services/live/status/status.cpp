#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/bus_options.hpp"
#include "cli/command.hpp"
#include "cli/live_commands.hpp"
#include "live/command.hpp"
#include "live/status/listener.hpp"
#include "live/status/table.hpp"
#include "status/json.hpp"
#include "status/judgement.hpp"

namespace fathom::cli {
namespace {

using status::StatusView;

struct StatusOptions {
  bus::ParticipantOptions bus;
  std::string vehicle;
  double timeout_s = 3.0;
  double period_s = 1.0;
  bool watch = false;
  bool json = false;
};

volatile std::sig_atomic_t interrupted = 0;

void end_on_signal() {
  struct sigaction action {};
  action.sa_handler = [](int) { interrupted = 1; };
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

void pause_for(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

bool wants_colour() {
  return isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr;
}

void print(const StatusView& view, bool json) {
  if (json) {
    std::puts(status::json_line(view).c_str());
  } else {
    for (const std::string& line : table(view, width_of(STDOUT_FILENO), wants_colour()))
      std::puts(line.c_str());
  }
  std::fflush(stdout);
}

/// The terminal's second screen, so that the shell's is there again afterwards.
class FullScreen {
 public:
  explicit FullScreen(bool wanted) : on_(wanted) {
    if (on_) std::fputs("\x1b[?1049h\x1b[?25l", stdout);
  }
  ~FullScreen() {
    if (on_) std::fputs("\x1b[?25h\x1b[?1049l", stdout);
    std::fflush(stdout);
  }
  FullScreen(const FullScreen&) = delete;
  FullScreen& operator=(const FullScreen&) = delete;

  /// In one write, over what is there: nothing flickers.
  void draw(const std::vector<std::string>& lines) const {
    winsize size{};
    std::size_t room = 1000;
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_row > 1) room = size.ws_row - 1U;
    std::string out = "\x1b[H";
    for (std::size_t i = 0; i < lines.size() && i < room; ++i) out += lines[i] + "\x1b[K\r\n";
    out += "\x1b[J";
    std::fwrite(out.data(), 1, out.size(), stdout);
    std::fflush(stdout);
  }

 private:
  bool on_;
};

/// Returns what was shown last.
StatusView watch(const StatusListener& listener, const StatusOptions& options) {
  const bool full_screen = !options.json && isatty(STDOUT_FILENO) != 0;
  const FullScreen screen(full_screen);
  StatusView view;
  while (interrupted == 0) {
    view = listener.view();
    if (full_screen) {
      screen.draw(table(view, width_of(STDOUT_FILENO), wants_colour()));
    } else {
      print(view, options.json);
      if (!options.json) std::puts("");
    }
    for (double slept = 0.0; slept < options.period_s && interrupted == 0; slept += 0.05) pause_for(0.05);
  }
  return view;
}

ExitCode run(const StatusOptions& options) {
  end_on_signal();
  const StatusListener listener(options.bus, options.vehicle);
  StatusView shown;
  if (options.watch) {
    shown = watch(listener, options);
  } else {
    for (double waited = 0.0; waited < options.timeout_s && interrupted == 0 && !listener.complete();
         waited += 0.05) {
      pause_for(0.05);
    }
    shown = listener.view();
    print(shown, options.json);
  }
  // The conditions are numbered as the exit codes of this command are.
  return static_cast<ExitCode>(judge(shown).condition);
}

}  // namespace

void add_status(CLI::App& app, ExitCode& exit_code) {
  auto options = std::make_shared<StatusOptions>();
  options->bus.name = "fathom_status";
  options->bus.low_priority = true;
  CLI::App* command = app.add_subcommand(kStatus.name, kStatus.description);
  command->footer("Exit code: 0 healthy, 1 degraded, 2 no navigation.");
  command->add_flag("--watch", options->watch, "Keep showing until interrupted");
  command->add_flag("--json", options->json, "One line of JSON, with --watch one each period");
  command->add_option("--vehicle", options->vehicle, "Name of the vehicle; default: the first one heard");
  add_bus_options(*command, options->bus, "cli");
  command->add_option("--timeout", options->timeout_s, "Seconds to listen at most")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  command->add_option("--period", options->period_s, "Seconds between two views with --watch")
      ->check(CLI::Range(0.1, 60.0))
      ->capture_default_str();
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fathom::cli

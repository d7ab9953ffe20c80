#include "host/run.hpp"

#include <algorithm>
#include <atomic>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>
#include <poll.h>
#include <unistd.h>

#include "config/vehicle/folder.hpp"
#include "config/vehicle/vehicle_config.hpp"
#include "runtime/build_info.hpp"
#include "runtime/leave.hpp"
#include "runtime/signals.hpp"

namespace fathom::host {
namespace {

/// Standard error may be a pipe that nobody reads, and the log's thread may hang in it: whoever ends does not
/// wait for either.
int fail(const std::string& executable, ExitCode code, const std::string& message, bool of_lines = false) {
  constexpr int kPatience_ms = 1000;
  const std::string said_by = executable + ": ";
  std::string line = said_by;
  for (const char c : message) {
    if (c != '\n')
      line += c;
    else
      line += of_lines ? c + said_by : " ";
  }
  line.resize(std::min<std::size_t>(line.size(), PIPE_BUF - 1));  // what a pipe with room takes as a whole
  line += '\n';
  pollfd standard_error{STDERR_FILENO, POLLOUT, 0};
  if (poll(&standard_error, 1, kPatience_ms) == 1) (void)!::write(STDERR_FILENO, line.data(), line.size());
  return static_cast<int>(code);
}

std::atomic<runtime::Log*> last_log = nullptr;

/// An exception that nobody catches: the line that explains it is in the log, and may wait for the log's
/// thread.
[[noreturn]] void end_by_exception() {
  if (runtime::Log* log = last_log) {
    try {
      if (std::current_exception()) throw;
      log->error("it cannot go on");
    } catch (const std::exception& error) {
      log->error(std::string("nobody caught an exception: ") + error.what());
    } catch (...) {
      log->error("nobody caught an exception, which is of no known type");
    }
    log->flush();
  }
  std::abort();
}

/// As long as this lives, the log is complete when the process ends by an exception.
class LastWords {
 public:
  explicit LastWords(runtime::Log& log) : before_(std::set_terminate(end_by_exception)) { last_log = &log; }
  ~LastWords() {
    last_log = nullptr;
    std::set_terminate(before_);
  }
  LastWords(const LastWords&) = delete;
  LastWords& operator=(const LastWords&) = delete;

 private:
  std::terminate_handler before_;
};

/// The exit code of run_service(), everything of the service having ended.
int serve(int argc, char** argv, const ServiceInfo& info, const std::function<std::string()>& explain,
          const std::function<Prepared(const config::LoadRequest&, bool check)>& load,
          const std::function<ExitCode(ServiceHost&)>& body) {
  runtime::block_stop_signals();
  std::string executable = "fathom-" + info.name;
  for (char& c : executable) {
    if (c == '_') c = '-';
  }
  CLI::App app{info.description, executable};
  config::LoadRequest request;
  std::string vehicle;
  std::string folder;
  bool check = false;
  bool explains = false;
  CLI::Option* own =
      app.add_option("--config", request.file,
                     "configuration file (JSON); with --vehicle it needs to say only what is different here");
  CLI::Option* of_vehicle =
      app.add_option("--vehicle", vehicle, "file of the vehicle (JSON): what it says of this service");
  app.add_option("--folder", folder,
                 "a folder with both, e.g. /etc/fathom: vehicle.json, and " + info.name +
                     ".json over it; one of them may be missing")
      ->excludes(own)
      ->excludes(of_vehicle);
  app.add_option("--set", request.sets, "override: key.sub=value, may be repeated")->allow_extra_args(false);
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (type.starts_with("TEXT"))
      option->check([](const std::string& text) { return text.empty() ? "is empty, expected a value" : ""; },
                    "", "");
  }
  app.add_flag("--check", check, "check the configuration and exit");
  app.add_flag("--explain", explains,
               "print the keys of the configuration with unit, range, default and meaning, and exit");
  app.set_version_flag("--version", executable + " " + std::string(runtime::version()));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    return fail(executable, ExitCode::bad_configuration, std::string(error.what()) + "; see --help");
  }
  if (explains) {
    std::fputs(explain().c_str(), stdout);
    return static_cast<int>(ExitCode::done);
  }
  if (request.file.empty() && vehicle.empty() && folder.empty())
    return fail(executable, ExitCode::bad_configuration,
                "--vehicle, --config or --folder is required; see --help");
  std::string named = request.file;
  try {
    if (!folder.empty()) request = config::from_folder(std::move(request), folder, info.name);
    if (!vehicle.empty()) request = config::with_vehicle(std::move(request), vehicle, info.name);
    named = request.name();
    Prepared prepared = load(request, check);
    if (check) {
      std::printf("%s: %s: valid\n", executable.c_str(), config::files_of(request).c_str());
      return static_cast<int>(ExitCode::done);
    }
    ServiceInfo own = info;
    if (!prepared.instance.empty()) own.name = prepared.instance;
    ServiceHost host({own, std::move(prepared.common), std::move(prepared.config_hash),
                      std::move(prepared.discovery_listen)});
    const LastWords last_words(host.log());
    if (request.base) host.log().info("configured by " + config::files_of(request));
    return static_cast<int>(body(host));
  } catch (const config::ConfigError& error) {
    return fail(executable, ExitCode::bad_configuration, error.what(), true);
  } catch (const bus::CredentialsError& error) {
    return fail(executable, ExitCode::bad_configuration, named + ": bus.security: " + error.what());
  } catch (const std::exception& error) {
    return fail(executable, ExitCode::runtime_failure, error.what());
  }
}

}  // namespace

int run_service(int argc, char** argv, const ServiceInfo& info, const std::function<std::string()>& explain,
                const std::function<Prepared(const config::LoadRequest&, bool check)>& load,
                const std::function<ExitCode(ServiceHost&)>& body) {
  return runtime::leave(serve(argc, argv, info, explain, load, body));
}

}  // namespace fathom::host

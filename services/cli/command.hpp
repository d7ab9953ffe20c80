#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "base/exit_code.hpp"
#include "cli/program.hpp"

namespace CLI {
class App;
}

namespace fathom::cli {

/// Ends a sub-command that cannot do its work. main() prints `fathom: MESSAGE` as one line on stderr and ends
/// with the code. The message reads `FILE: key or line: what is wrong, what was expected`.
class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Throws Failure where the file cannot be written.
void write_text(const std::string& path, const std::string& text);

// A sub-command is one file NAME.cpp with one function
//
//   void add_NAME(CLI::App& app, ExitCode& exit_code);
//
// declared below and listed in commands.cpp. It adds the sub-command with its options and a callback that
// does the work. Option values live in a std::shared_ptr that the callback holds. The callback throws
// Failure, or sets `exit_code` where the answer is not plain success ("no", "unhealthy").

void add_decode(CLI::App& app, ExitCode& exit_code);
void add_solve(CLI::App& app, ExitCode& exit_code);
void add_commission(CLI::App& app, ExitCode& exit_code);
void add_simulate(CLI::App& app, ExitCode& exit_code);
void add_study(CLI::App& app, ExitCode& exit_code);
void add_bench(CLI::App& app, ExitCode& exit_code);
void add_config(CLI::App& app, ExitCode& exit_code);
void add_init(CLI::App& app, ExitCode& exit_code);
void add_run(CLI::App& app, ExitCode& exit_code);
void add_keygen(CLI::App& app, ExitCode& exit_code);
void add_import(CLI::App& app, ExitCode& exit_code);
void add_export(CLI::App& app, ExitCode& exit_code);
void add_report(CLI::App& app, ExitCode& exit_code);
void add_plot(CLI::App& app, ExitCode& exit_code);

/// Those of fathom. `argv`, which is that of main(), goes to fathom-live where a command joins the network.
[[nodiscard]] std::vector<SubCommand> commands(char** argv);

}  // namespace fathom::cli

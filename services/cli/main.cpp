#include <algorithm>
#include <cstdio>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/exit_code.hpp"
#include "base/nearest.hpp"
#include "bus/option_error.hpp"
#include "cli/command.hpp"
#include "config/json/error.hpp"
#include "runtime/build_info.hpp"

namespace {

int fail(fathom::ExitCode code, std::string message) {
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  std::fprintf(stderr, "fathom: %s\n", message.c_str());
  return static_cast<int>(code);
}

/// A line for each mistake.
int fail(const fathom::config::ConfigError& error) {
  std::istringstream mistakes(error.what());
  for (std::string one; std::getline(mistakes, one);) fail(fathom::ExitCode::bad_configuration, one);
  return static_cast<int>(fathom::ExitCode::bad_configuration);
}

/// What to say where the first word is no sub-command; empty otherwise.
std::string unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return {};
  const std::string word = argv[1];
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return {};
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  const auto meant = fathom::nearest(word, names);
  return word + ": unknown, " + (meant ? "nearest is " + *meant : "there are " + list) + "; see --help";
}

}  // namespace

int main(int argc, char** argv) {
  using fathom::ExitCode;
  CLI::App app{"Navigation as services on a vehicle network.", "fathom"};
  app.set_version_flag("--version", "fathom " + std::string(fathom::runtime::version()));
  app.require_subcommand(1);
  ExitCode exit_code = ExitCode::done;
  fathom::cli::add_commands(app, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(app, argc, argv); !unknown.empty())
      return fail(ExitCode::bad_configuration, unknown);
    return fail(ExitCode::bad_configuration, std::string(error.what()) + "; see --help");
  } catch (const fathom::cli::Failure& failure) {
    return fail(failure.code(), failure.what());
  } catch (const fathom::config::ConfigError& error) {
    return fail(error);
  } catch (const fathom::bus::OptionError& error) {
    return fail(ExitCode::bad_configuration, error.what());
  } catch (const fathom::bus::CredentialsError& error) {
    return fail(ExitCode::bad_configuration, error.what());
  } catch (const std::exception& error) {
    return fail(ExitCode::runtime_failure, error.what());
  }
  return static_cast<int>(exit_code);
}

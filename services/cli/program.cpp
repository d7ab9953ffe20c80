#include "cli/program.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
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

namespace fathom::cli {
namespace {

int fail(ExitCode code, std::string message) {
  for (char& c : message) {
    if (c == '\n') c = ' ';
  }
  std::fprintf(stderr, "fathom: %s\n", message.c_str());
  return static_cast<int>(code);
}

/// A line for each mistake.
int fail(const config::ConfigError& error) {
  std::istringstream mistakes(error.what());
  for (std::string one; std::getline(mistakes, one);) fail(ExitCode::bad_configuration, one);
  return static_cast<int>(ExitCode::bad_configuration);
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
  const auto meant = nearest(word, names);
  return word + ": unknown, " + (meant ? "nearest is " + *meant : "there are " + list) + "; see --help";
}

/// What is wrong with a decimal number. A range lets "nan" pass: it is neither below nor above.
std::string float_complaint(const std::string& text) {
  return std::isfinite(std::strtod(text.c_str(), nullptr)) ? "" : "is " + text + ", expected a finite number";
}

/// What is wrong with a whole number that is never negative: C takes -1 for the largest one.
std::string count_complaint(const std::string& text) {
  errno = 0;
  (void)std::strtoull(text.c_str(), nullptr, 0);
  const bool fits = errno != ERANGE && text.find('-') == std::string::npos;
  return fits ? "" : "is " + text + ", expected a whole number from 0 to 18446744073709551615";
}

/// What is wrong with the name of a file or of anything else: an empty one is that of a variable which nobody
/// has set.
std::string text_complaint(const std::string& text) {
  return text.empty() ? "is empty, expected a value" : "";
}

void check_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (type.starts_with("TEXT")) option->check(text_complaint, "", "");
    if (type.starts_with("FLOAT")) option->check(float_complaint, "", "");
    if (type.starts_with("UINT")) option->check(count_complaint, "", "");
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) check_values(*command);
}

}  // namespace

void add(CLI::App& app, const std::vector<SubCommand>& commands, ExitCode& exit_code) {
  for (const SubCommand& command : commands) command.add(app, exit_code);
  check_values(app);
}

int run_program(int argc, char** argv, const std::vector<SubCommand>& commands) {
  CLI::App app{"Navigation as services on a vehicle network.", "fathom"};
  app.set_version_flag("--version", "fathom " + std::string(runtime::version()));
  app.require_subcommand(1);
  ExitCode exit_code = ExitCode::done;
  const auto asked = std::find_if(commands.begin(), commands.end(), [&](const SubCommand& command) {
    return argc > 1 && command.name == argv[1];
  });
  add(app, asked == commands.end() ? commands : std::vector<SubCommand>{*asked}, exit_code);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(app, argc, argv); !unknown.empty())
      return fail(ExitCode::bad_configuration, unknown);
    return fail(ExitCode::bad_configuration, std::string(error.what()) + "; see --help");
  } catch (const Failure& failure) {
    return fail(failure.code(), failure.what());
  } catch (const config::ConfigError& error) {
    return fail(error);
  } catch (const bus::OptionError& error) {
    return fail(ExitCode::bad_configuration, error.what());
  } catch (const bus::CredentialsError& error) {
    return fail(ExitCode::bad_configuration, error.what());
  } catch (const std::exception& error) {
    return fail(ExitCode::runtime_failure, error.what());
  }
  return static_cast<int>(exit_code);
}

}  // namespace fathom::cli

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/command.hpp"

namespace fathom::cli {
namespace {

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

void add_commands(CLI::App& app, ExitCode& exit_code) {
  add_decode(app, exit_code);
  add_status(app, exit_code);
  add_fix(app, exit_code);
  add_solve(app, exit_code);
  add_commission(app, exit_code);
  add_simulate(app, exit_code);
  add_study(app, exit_code);
  add_bench(app, exit_code);
  add_doctor(app, exit_code);
  add_config(app, exit_code);
  add_init(app, exit_code);
  add_run(app, exit_code);
  add_keygen(app, exit_code);
  add_import(app, exit_code);
  add_export(app, exit_code);
  add_explain(app, exit_code);
  add_report(app, exit_code);
  add_plot(app, exit_code);
  add_record(app, exit_code);
  add_replay(app, exit_code);
  check_values(app);
}

}  // namespace fathom::cli

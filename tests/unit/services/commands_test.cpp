#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "cli/command.hpp"
#include "live/command.hpp"

namespace fathom::cli {
namespace {

/// The whole command line, as both programs have it.
class Commands : public ::testing::Test {
 protected:
  Commands() {
    add(app_, commands(nullptr), exit_code_);
    add(live_, live_commands(), exit_code_);
  }

  /// Every option of every sub-command whose value is of this type, by the name "solve --rate".
  std::vector<std::pair<std::string, CLI::Option*>> options_of(const std::string& type) {
    std::vector<std::pair<std::string, CLI::Option*>> out;
    gather(app_, "", type, out);
    gather(live_, "", type, out);
    return out;
  }
  static bool takes(CLI::Option& option, const std::string& value) {
    option.clear();
    option.add_result(value);
    try {
      option.run_callback();
    } catch (const CLI::ParseError&) {
      option.clear();
      return false;
    }
    option.clear();
    return true;
  }

 private:
  static void gather(CLI::App& app, const std::string& path, const std::string& type,
                     std::vector<std::pair<std::string, CLI::Option*>>& out) {
    for (CLI::Option* option : app.get_options())
      if (option->get_type_name().find(type) != std::string::npos)
        out.emplace_back(path + option->get_name(), option);
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
      gather(*command, path + command->get_name() + " ", type, out);
  }

  CLI::App app_{"", "fathom"};
  CLI::App live_{"", "fathom"};
  ExitCode exit_code_ = ExitCode::done;
};

TEST_F(Commands, NoDecimalNumberMayBeNoneOrEndless) {
  std::set<std::string> names;
  for (const auto& [name, option] : options_of("FLOAT")) {
    names.insert(name);
    for (const char* value : {"nan", "-nan", "NAN", "inf", "-inf", "infinity", "1e999"})
      EXPECT_FALSE(takes(*option, value)) << name << " " << value;
  }
  for (const char* name :
       {"fix --ago", "fix --lat", "fix --depth", "status --timeout", "doctor --seconds", "record --duration",
        "simulate --duration", "init --latitude", "decode --latitude", "decode --scale",
        "decode --atmosphere", "solve --rate", "export --rate", "replay --speed", "explain --last",
        "explain --listen", "import --surface-pressure"})
    EXPECT_TRUE(names.contains(name)) << name;
}

TEST_F(Commands, NoCountMayBeNegativeOrTooLarge) {
  std::set<std::string> names;
  for (const auto& [name, option] : options_of("UINT")) {
    names.insert(name);
    for (const char* value : {"-1", "99999999999999999999"})
      EXPECT_FALSE(takes(*option, value)) << name << " " << value;
    const bool takes_two = name == "keygen --domains";
    EXPECT_EQ(takes(*option, "7"), !takes_two) << name;
  }
  EXPECT_TRUE(names.contains("simulate --seed"));
  EXPECT_TRUE(names.contains("study --seed"));
}

TEST_F(Commands, NoTextMayBeEmpty) {
  std::set<std::string> names;
  for (const auto& [name, option] : options_of("TEXT")) {
    names.insert(name);
    const bool may_have_no_value = option->get_expected_min() == 0;
    EXPECT_EQ(takes(*option, ""), may_have_no_value) << name;
  }
  for (const char* name : {"record --recover", "record --out", "solve --vehicle", "solve directory",
                           "config show --folder", "status --profiles", "init --serial", "decode file"})
    EXPECT_TRUE(names.contains(name)) << name;
}

}  // namespace
}  // namespace fathom::cli

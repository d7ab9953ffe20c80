#pragma once

namespace CLI {
class App;
}

namespace fathom::cli {

/// A command that joins the vehicle network. `fathom` knows its name and what it is for. The program
/// fathom-live beside it does the work. So commands that work on files neither need Fast DDS nor wait some
/// 20 ms until it is loaded.
struct LiveCommand {
  const char* name;
  const char* description;
};

inline constexpr LiveCommand kStatus{"status", "Shows how the vehicle and its navigation are."};
inline constexpr LiveCommand kFix{
    "fix", "Tells the vehicle where it was: a position by hand, minutes old if need be."};
inline constexpr LiveCommand kDoctor{"doctor",
                                     "Checks the vehicle network and this host, and says what to do."};
inline constexpr LiveCommand kRecord{
    "record", "Records everything that is said on the vehicle network into an MCAP file, until Ctrl-C."};
inline constexpr LiveCommand kReplay{"replay",
                                     "Publishes a recording on the vehicle network again, as it arrived."};

/// Adds it, whatever follows its name: `argv`, which is that of main(), goes to fathom-live as it is.
void add_live_command(CLI::App& app, const LiveCommand& command, char** argv);

/// Becomes fathom-live. Throws Failure where that is not there.
[[noreturn]] void hand_over(char** argv);

}  // namespace fathom::cli

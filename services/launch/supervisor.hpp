#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "base/time.hpp"
#include "launch/life_signs.hpp"

namespace fathom::launch {

/// One service that is started.
struct Program {
  std::string name;  ///< service name, e.g. "gps_bridge"
  std::filesystem::path executable;
  std::vector<std::string> arguments;
  bool optional = false;  ///< the run goes on without it
};

/// Starts services, notices when one ends, starts it again, and stops them all. A service ends with its
/// parent whatever happens to the parent. Output goes to one log file per service. Not thread-safe.
///
/// Once a service has run, nothing that befalls its next start ends the others: one that cannot be started,
/// or that refuses a configuration which was changed meanwhile, is tried again for ever.
class Supervisor {
 public:
  /// `restart_after_ns`: pause before a service that ended is started again, host time. `silence_ns`: one
  /// that has given life signs and then gives none for so long hangs: it is killed and started again. To
  /// begin anew it gets nine times as long. 0: nobody asks for life signs.
  Supervisor(std::filesystem::path log_directory, DurationNs restart_after_ns, DurationNs silence_ns = 0);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Throws std::system_error when the program cannot be started.
  void start(const Program& program);

  /// Reaps, kills what hangs, and restarts. Returns one sentence per service that ended or was started again
  /// since the last call.
  std::vector<std::string> poll(TimeNs now_ns);

  /// SIGTERM to all, SIGKILL to those that are left after `grace_ns`. Returns the names of the latter.
  std::vector<std::string> stop(DurationNs grace_ns);

  /// How often each service was started again.
  [[nodiscard]] std::map<std::string, int> restarts() const;
  /// A service that is needed refused its configuration (exit code 2) when it was started first: starting it
  /// again would not help.
  [[nodiscard]] bool gave_up() const { return gave_up_; }
  [[nodiscard]] std::filesystem::path log_of(const std::string& name) const;

 private:
  struct Child {
    Program program;
    pid_t pid = -1;
    TimeNs ended_ns = 0;
    int restarts = 0;
    bool hopeless = false;
    TimeNs started_ns = 0;     ///< of the last start by poll()
    bool speaks = false;       ///< it has given life signs, now or before it was started again
    bool spoke = false;        ///< it has since it was started
    DurationNs silent_ns = 0;  ///< since the last one or since it was started, while somebody listened
    std::string trouble{};     ///< why it cannot be started again; said once, as long as it is the same
  };

  void spawn(Child& child);
  /// A file descriptor. One that is started again does without a log where there can be none.
  [[nodiscard]] int open_log(const Child& child) const;
  /// Does what is due for one service, and says it.
  void reap(Child& child, TimeNs now_ns, std::vector<std::string>& said);
  void start_again(Child& child, TimeNs now_ns, std::vector<std::string>& said);
  void kill_what_hangs(TimeNs now_ns, std::vector<std::string>& said);

  std::filesystem::path log_directory_;
  DurationNs restart_after_ns_;
  DurationNs silence_ns_;
  std::optional<LifeSigns> life_signs_;  ///< none: nobody asks for them
  TimeNs listened_ns_ = 0;
  std::vector<Child> children_;
  bool gave_up_ = false;
};

}  // namespace fathom::launch

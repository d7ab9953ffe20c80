#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <sys/types.h>

#include "base/time.hpp"

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
class Supervisor {
 public:
  /// `restart_after_ns`: pause before a service that ended is started again, host time.
  Supervisor(std::filesystem::path log_directory, DurationNs restart_after_ns);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Throws std::system_error when the program cannot be started.
  void start(const Program& program);

  /// Reaps and restarts. Returns one sentence per service that ended or was started again since the last
  /// call.
  std::vector<std::string> poll(TimeNs now_ns);

  /// SIGTERM to all, SIGKILL to those that are left after `grace_ns`. Returns the names of the latter.
  std::vector<std::string> stop(DurationNs grace_ns);

  /// How often each service was started again.
  [[nodiscard]] std::map<std::string, int> restarts() const;
  /// A service that is needed refused its configuration (exit code 2): starting it again would not help.
  [[nodiscard]] bool gave_up() const { return gave_up_; }
  [[nodiscard]] std::filesystem::path log_of(const std::string& name) const;

 private:
  struct Child {
    Program program;
    pid_t pid = -1;
    TimeNs ended_ns = 0;
    int restarts = 0;
    bool hopeless = false;
  };

  void spawn(Child& child);

  std::filesystem::path log_directory_;
  DurationNs restart_after_ns_;
  std::vector<Child> children_;
  bool gave_up_ = false;
};

}  // namespace fathom::launch

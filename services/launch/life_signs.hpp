#pragma once

#include <set>
#include <string>

#include <sys/types.h>

namespace fathom::launch {

/// The place where services say that they live, as they say it to systemd (sd_notify). A socket without a
/// file: no folder can be tidied away below it. Not thread-safe.
class LifeSigns {
 public:
  /// Throws std::system_error when there is no socket to be had.
  LifeSigns();
  ~LifeSigns();
  LifeSigns(const LifeSigns&) = delete;
  LifeSigns& operator=(const LifeSigns&) = delete;

  /// What a service has to have in its environment: "NOTIFY_SOCKET=...".
  [[nodiscard]] const std::string& variable() const { return variable_; }
  /// The processes that have said something since the last call. The kernel vouches for their numbers.
  [[nodiscard]] std::set<pid_t> heard();

 private:
  int socket_ = -1;
  std::string variable_;
};

}  // namespace fathom::launch

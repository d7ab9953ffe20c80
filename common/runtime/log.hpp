#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace fathom::runtime {

enum class LogLevel { trace, debug, info, warning, error };

/// One word of LogLevel; nothing for other text.
[[nodiscard]] bool parse_log_level(std::string_view word, LogLevel& level);

/// A service's log: one line per event on standard error with UTC time, service and level. Thread-safe; the
/// object is passed around by reference, there is no global one. Nobody waits for standard error: a pipe that
/// nobody reads or a disk that is busy costs lines, and how many is said afterwards.
class Log {
 public:
  Log(std::string_view service, LogLevel level);
  ~Log();  ///< flushes
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  void trace(std::string_view text);
  void debug(std::string_view text);
  void info(std::string_view text);
  void warning(std::string_view text);
  void error(std::string_view text);
  void write(LogLevel level, std::string_view text);

  /// Waits until everything is written, a second at most; false: it is not.
  bool flush();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Says a thing once until it changes: a lost cable is one line, its return another, however often the state
/// is reported in between. Not thread-safe: one per watched thing, used by one thread.
class SayOnce {
 public:
  /// Logs `text` when `state` differs from the one said last. Returns whether it logged.
  bool say(Log& log, LogLevel level, std::string_view state, std::string_view text);
  /// The next say() logs whatever its state.
  void forget() { last_.clear(); }

 private:
  std::string last_;
};

}  // namespace fathom::runtime

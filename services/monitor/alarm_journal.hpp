#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"
#include "health/alarm_book.hpp"
#include "samples/status/health.hpp"

namespace fathom::monitor {

/// Append-only record of alarms: one JSON object a line, on the disk (fdatasync) before append() returns.
///
/// A line is written in one piece. When a power cut leaves half a line at the end, the next start replaces it
/// by a "repaired" line that quotes it. So the file is JSON lines from its first byte to its last, and a line
/// that was complete is never touched. When the disk has no room for a line, the whole line is taken back.
/// One process at a time writes a journal.
class AlarmJournal {
 public:
  struct Counters {
    std::uint64_t lines = 0;     ///< written and synchronised
    std::uint64_t failures = 0;  ///< lines that could not be
    std::uint64_t repaired_bytes = 0;
  };

  /// Opens nothing yet. open() makes missing folders.
  explicit AlarmJournal(std::string path) : path_(std::move(path)) {}
  ~AlarmJournal();
  AlarmJournal(const AlarmJournal&) = delete;
  AlarmJournal& operator=(const AlarmJournal&) = delete;

  /// Opens and repairs. False: error() says why, and the caller may try again later.
  bool open(TimeNs utc_ns);
  /// Alarms that were active or that nobody had acknowledged when the journal ended, in their last state, as
  /// open() found them.
  [[nodiscard]] const std::vector<Alarm>& latched() const { return latched_; }
  [[nodiscard]] bool is_open() const { return file_ >= 0; }
  bool append(const health::AlarmTransition& transition, TimeNs utc_ns);
  /// Writes the monitor's own start or end. A start with no end before it follows a crash.
  bool note(std::string_view event, std::string_view text, TimeNs utc_ns);

  /// Why the last call failed, in one line. Empty when it succeeded.
  [[nodiscard]] const std::string& error() const { return error_; }
  [[nodiscard]] const Counters& counters() const { return counters_; }

 private:
  bool repair(TimeNs utc_ns);
  void read_latched();
  bool write_line(const std::string& line);
  bool fail(const char* what);
  void close();

  std::string path_;
  int file_ = -1;
  std::string error_;
  Counters counters_;
  std::vector<Alarm> latched_;
};

}  // namespace fathom::monitor

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.hpp"
#include "samples/status/health.hpp"

namespace fathom::monitor {

enum class JournalEvent : std::uint8_t { raised, worsened, cleared, acknowledged };
[[nodiscard]] std::string_view to_string(JournalEvent event);

/// Append-only record of alarms: one JSON object a line, on the disk (fdatasync) before append() returns.
///
/// A line is written in one piece. What a power cut left of the last one is replaced at the next start by a
/// "repaired" line that quotes it, so that the file is JSON lines from its first byte to its last and nothing
/// that was ever complete is touched. A line that the disk had no room for is taken back whole. One process
/// writes a journal at a time.
class AlarmJournal {
 public:
  struct Counters {
    std::uint64_t lines = 0;     ///< written and synchronised
    std::uint64_t failures = 0;  ///< lines that could not be
    std::uint64_t repaired_bytes = 0;
  };

  /// Opens nothing yet. Folders that are missing are made.
  explicit AlarmJournal(std::string path) : path_(std::move(path)) {}
  ~AlarmJournal();
  AlarmJournal(const AlarmJournal&) = delete;
  AlarmJournal& operator=(const AlarmJournal&) = delete;

  /// Opens and repairs. False: error() says why; to be tried again later.
  bool open(TimeNs utc_ns);
  /// As of open(): alarms that were active or that nobody had acknowledged when the journal ended, in their
  /// last state.
  [[nodiscard]] const std::vector<Alarm>& latched() const { return latched_; }
  [[nodiscard]] bool is_open() const { return file_ >= 0; }
  bool append(const Alarm& alarm, JournalEvent event, TimeNs utc_ns);
  /// The monitor's own beginning and end: a beginning without an end before it was a crash.
  bool note(std::string_view event, std::string_view text, TimeNs utc_ns);

  /// One line, as of the last call that failed; empty when the last one succeeded.
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

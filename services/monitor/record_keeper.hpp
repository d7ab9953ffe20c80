#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/clock.hpp"
#include "monitor/alarm_journal.hpp"
#include "monitor/outage_file.hpp"
#include "runtime/log.hpp"

namespace fathom::monitor {

/// Keeper of what the monitor has on the disk: the journal of alarms and the books of GPS outages. It writes
/// on a thread of its own, so that nobody who judges or publishes waits for a disk that is slow, full or
/// gone. Lines wait in a queue. What finds it full is dropped, counted and said: in the log, and in the
/// journal once the disk answers again. Of the books only the newest wait. A failure is logged when it is
/// new.
class RecordKeeper {
 public:
  static constexpr std::size_t kMostLines = 1024;

  struct State {
    AlarmJournal::Counters journal;
    std::uint64_t dropped = 0;  ///< lines that found the queue full
    std::string trouble;        ///< why the journal is not written now; empty when it is
  };

  /// Reads the books and opens the journal, which waits for the disk. `path` of the journal; empty: nothing
  /// is kept.
  RecordKeeper(const std::string& path, const Name& vehicle, const Clock& clock, runtime::Log& log);
  /// Writes what waits.
  ~RecordKeeper();
  RecordKeeper(const RecordKeeper&) = delete;
  RecordKeeper& operator=(const RecordKeeper&) = delete;

  /// The books of before, as they were read.
  [[nodiscard]] const std::vector<health::GpsOutageBook>& books_of_before() const { return books_of_before_; }
  /// The alarms that the journal held when it was opened, once for each time that it was.
  [[nodiscard]] std::vector<Alarm> take_latched();
  [[nodiscard]] State state() const;

  void append(const health::AlarmTransition& transition, TimeNs utc_ns);
  void keep(std::vector<health::GpsOutageBook> books);
  /// The monitor ends in good order: the last line will say so.
  void finish();

 private:
  struct Line {
    health::AlarmTransition transition;
    TimeNs utc_ns = 0;
  };
  struct Work {
    std::deque<Line> lines;
    std::uint64_t dropped = 0;  ///< after those lines
    std::optional<std::vector<health::GpsOutageBook>> books;
  };

  void run();
  void write(const Work& work);
  void open();
  /// Whether so many seconds of the host have passed since then: a disk is no faster on a vehicle whose clock
  /// runs faster.
  [[nodiscard]] bool passed(DurationNs host_ns, TimeNs since_ns) const;
  /// The disk has answered: the journal's counters and trouble are as they are now.
  void answered();
  void complain(const std::string& trouble, std::string& known);

  const std::string path_;
  const Name vehicle_;
  const Clock& clock_;
  runtime::Log& log_;
  std::vector<health::GpsOutageBook> books_of_before_;

  // Of the keeper's thread, and of the constructor before it runs.
  AlarmJournal journal_;
  OutageFile outages_;
  std::string journal_trouble_;
  std::string outages_trouble_;
  TimeNs tried_ns_ = 0;  ///< of the clock that no step moves, as waits_since_ns_ is

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool stop_ = false;
  bool finished_ = false;
  Work work_;
  std::vector<Alarm> latched_;
  State state_;
  std::optional<TimeNs> waits_since_ns_;  ///< for the disk
  std::thread thread_;                    ///< last: it uses everything above
};

}  // namespace fathom::monitor

#include "monitor/alarm_journal.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fathom::monitor {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostQuoted = 1024;
constexpr off_t kMostRead = 1 << 20;  // of an old journal: what was not acknowledged for longer is history

ordered_json number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json instant(TimeNs utc_ns) {
  return utc_ns == 0 ? ordered_json(nullptr) : ordered_json(to_iso8601(utc_ns));
}

std::string line_of(const ordered_json& entry) {
  return entry.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

/// 0 when it is no instant as instant() writes it.
TimeNs instant_of(const ordered_json& entry, const char* key) {
  const auto found = entry.find(key);
  if (found == entry.end() || !found->is_string()) return 0;
  int year = 0;
  int month = 0;
  int day = 0;
  int hour = 0;
  int minute = 0;
  int second = 0;
  int millisecond = 0;
  if (std::sscanf(found->get_ref<const std::string&>().c_str(), "%4d-%2d-%2dT%2d:%2d:%2d.%3dZ", &year, &month,
                  &day, &hour, &minute, &second, &millisecond) != 7) {
    return 0;
  }
  return from_civil({.year = year,
                     .month = month,
                     .day = day,
                     .hour = hour,
                     .minute = minute,
                     .second = second,
                     .nanosecond = millisecond * kNsPerMillisecond})
      .value_or(0);
}

/// Nothing when the line is no alarm's.
std::optional<Alarm> alarm_of(const ordered_json& entry) {
  const auto text = [&](const char* key) {
    const auto found = entry.find(key);
    return found != entry.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  const auto flag = [&](const char* key) {
    const auto found = entry.find(key);
    return found != entry.end() && found->is_boolean() && found->get<bool>();
  };
  const auto value = [&](const char* key) {
    const auto found = entry.find(key);
    return found != entry.end() && found->is_number() ? found->get<double>() : kUnknown;
  };
  Alarm alarm;
  alarm.header.vehicle = Name(text("vehicle"));
  alarm.alarm = Name(text("alarm"));
  if (alarm.alarm.empty()) return std::nullopt;
  for (const Severity severity : {Severity::notice, Severity::warning, Severity::critical}) {
    if (text("severity") == to_string(severity)) alarm.severity = severity;
  }
  alarm.active = flag("active");
  alarm.acknowledged = flag("acknowledged");
  alarm.since_ns = instant_of(entry, "since_utc");
  alarm.cleared_ns = instant_of(entry, "cleared_utc");
  alarm.text = text("text");
  alarm.value = value("value");
  alarm.limit = value("limit");
  return alarm;
}

/// Bytes behind the last end of line. Negative when the file cannot be read.
off_t torn_bytes(int file, off_t size) {
  std::array<char, 4096> block{};
  off_t end = size;
  while (end > 0) {
    const off_t begin = std::max<off_t>(0, end - static_cast<off_t>(block.size()));
    const ssize_t got = pread(file, block.data(), static_cast<std::size_t>(end - begin), begin);
    if (got != end - begin) return -1;
    const void* found = memrchr(block.data(), '\n', static_cast<std::size_t>(got));
    if (found != nullptr) return size - (begin + (static_cast<const char*>(found) - block.data()) + 1);
    end = begin;
  }
  return size;
}

/// A new file is only there after a power cut when its folder was synchronised.
void sync_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  (void)fsync(file);
  (void)::close(file);
}

}  // namespace

AlarmJournal::~AlarmJournal() {
  close();
}

void AlarmJournal::close() {
  if (file_ >= 0) (void)::close(file_);
  file_ = -1;
}

bool AlarmJournal::fail(const char* what) {
  error_ = "journal " + path_ + ": " + what + ": " + std::generic_category().message(errno);
  return false;
}

bool AlarmJournal::open(TimeNs utc_ns) {
  if (is_open()) return true;
  const std::filesystem::path path(path_);
  std::error_code ignored;  // whatever is wrong, open() says it better
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), ignored);
  // Without O_APPEND: with it Linux would not let the repair write where the torn line begins.
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0644);
  if (file_ < 0) return fail("cannot be opened");
  struct stat status {};
  bool good = false;
  if (fstat(file_, &status) != 0 || !S_ISREG(status.st_mode)) {
    error_ = "journal " + path_ + ": expected a regular file";
  } else if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    error_ = "journal " + path_ + ": another process writes it";
  } else {
    sync_folder(path);
    good = repair(utc_ns);
  }
  if (!good) close();
  if (good) {
    error_.clear();
    read_latched();
  }
  return good;
}

void AlarmJournal::read_latched() {
  latched_.clear();
  const off_t size = lseek(file_, 0, SEEK_END);
  const off_t begin = std::max<off_t>(0, size - kMostRead);
  std::string all(static_cast<std::size_t>(std::max<off_t>(0, size - begin)), '\0');
  if (pread(file_, all.data(), all.size(), begin) != static_cast<ssize_t>(all.size())) return;
  std::istringstream lines(all);
  for (std::string line; std::getline(lines, line);) {
    const auto entry = ordered_json::parse(line, nullptr, false);
    if (!entry.is_object()) continue;  // the first one read may be cut
    const auto alarm = alarm_of(entry);
    if (!alarm) continue;
    std::erase_if(latched_, [&](const Alarm& known) { return known.alarm == alarm->alarm; });
    if (alarm->active || !alarm->acknowledged) latched_.push_back(*alarm);
  }
}

bool AlarmJournal::repair(TimeNs utc_ns) {
  const off_t size = lseek(file_, 0, SEEK_END);
  const off_t torn = size < 0 ? -1 : torn_bytes(file_, size);
  if (torn < 0) return fail("cannot be read");
  if (torn == 0) return true;
  std::string rest(std::min<std::size_t>(static_cast<std::size_t>(torn), kMostQuoted), '\0');
  const off_t begin = size - torn;
  if (pread(file_, rest.data(), rest.size(), begin) != static_cast<ssize_t>(rest.size())) {
    return fail("cannot be read");
  }
  const std::string line = line_of({{"time_utc", instant(utc_ns)},
                                    {"event", "repaired"},
                                    {"text", "The last line was incomplete."},
                                    {"torn_bytes", torn},
                                    {"torn", rest}});
  // Over the torn line in one piece: cut again here, it is torn again, and repaired the next time.
  if (pwrite(file_, line.data(), line.size(), begin) != static_cast<ssize_t>(line.size()) ||
      ftruncate(file_, begin + static_cast<off_t>(line.size())) != 0 || fsync(file_) != 0) {
    return fail("cannot be repaired");
  }
  counters_.repaired_bytes += static_cast<std::uint64_t>(torn);
  return true;
}

bool AlarmJournal::write_line(const std::string& line) {
  if (!is_open()) {
    ++counters_.failures;
    return false;
  }
  const off_t begin = lseek(file_, 0, SEEK_END);
  const ssize_t written = begin < 0 ? -1 : pwrite(file_, line.data(), line.size(), begin);
  if (written != static_cast<ssize_t>(line.size())) {
    if (written >= 0) errno = ENOSPC;
    fail("cannot be written");
    // Half a line would swallow the next one.
    if (begin >= 0 && ftruncate(file_, begin) != 0) fail("ends with half a line");
    ++counters_.failures;
    return false;
  }
  if (fdatasync(file_) != 0) {
    ++counters_.failures;
    return fail("cannot be synchronised");
  }
  ++counters_.lines;
  error_.clear();
  return true;
}

bool AlarmJournal::append(const health::AlarmTransition& transition, TimeNs utc_ns) {
  const Alarm& alarm = transition.alarm;
  return write_line(line_of({{"time_utc", instant(utc_ns)},
                             {"event", to_string(transition.event)},
                             {"vehicle", alarm.header.vehicle.view()},
                             {"alarm", alarm.alarm.view()},
                             {"severity", to_string(alarm.severity)},
                             {"active", alarm.active},
                             {"acknowledged", alarm.acknowledged},
                             {"since_utc", instant(alarm.since_ns)},
                             {"cleared_utc", instant(alarm.cleared_ns)},
                             {"text", alarm.text},
                             {"value", number(alarm.value)},
                             {"limit", number(alarm.limit)}}));
}

bool AlarmJournal::note(std::string_view event, std::string_view text, TimeNs utc_ns) {
  return write_line(line_of({{"time_utc", instant(utc_ns)}, {"event", event}, {"text", text}}));
}

}  // namespace fathom::monitor

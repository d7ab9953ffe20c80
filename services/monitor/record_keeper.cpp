#include "monitor/record_keeper.hpp"

#include <chrono>
#include <utility>

#include <unistd.h>

#include "health/text.hpp"
#include "runtime/build_info.hpp"

namespace fathom::monitor {
namespace {

constexpr DurationNs kRetry_ns = 10 * kNsPerSecond;  // of a journal that could not be opened
constexpr DurationNs kHangs_ns = 5 * kNsPerSecond;   // a card that tidies itself up takes a second or two

}  // namespace

RecordKeeper::RecordKeeper(const std::string& path, const Name& vehicle, const Clock& clock,
                           runtime::Log& log)
    : path_(path), vehicle_(vehicle), clock_(clock), log_(log), journal_(path), outages_(path) {
  books_of_before_ = outages_.read(vehicle_);
  if (!outages_.error().empty()) log_.warning(outages_.error());
  open();
  thread_ = std::thread([this] { run(); });
}

RecordKeeper::~RecordKeeper() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

std::vector<Alarm> RecordKeeper::take_latched() {
  const std::lock_guard lock(mutex_);
  return std::exchange(latched_, {});
}

bool RecordKeeper::passed(DurationNs host_ns, TimeNs since_ns) const {
  return static_cast<double>(clock_.monotonic_ns() - since_ns) >=
         static_cast<double>(host_ns) * clock_.rate();
}

RecordKeeper::State RecordKeeper::state() const {
  const std::lock_guard lock(mutex_);
  State out = state_;
  if (waits_since_ns_ && passed(kHangs_ns, *waits_since_ns_))
    out.trouble = "journal " + path_ + ": the disk does not answer; " + std::to_string(work_.lines.size()) +
                  " lines wait, and " + std::to_string(state_.dropped) + " were dropped";
  return out;
}

void RecordKeeper::append(const health::AlarmTransition& transition, TimeNs utc_ns) {
  if (path_.empty()) return;
  bool first = false;
  {
    const std::lock_guard lock(mutex_);
    if (work_.lines.size() < kMostLines) {
      work_.lines.push_back({transition, utc_ns});
    } else {
      first = work_.dropped++ == 0;
      ++state_.dropped;
    }
  }
  if (first) log_.error("journal " + path_ + ": the disk does not keep up, and lines are dropped");
  wake_.notify_all();
}

void RecordKeeper::keep(std::vector<health::GpsOutageBook> books) {
  {
    const std::lock_guard lock(mutex_);
    work_.books = std::move(books);
  }
  wake_.notify_all();
}

void RecordKeeper::finish() {
  const std::lock_guard lock(mutex_);
  finished_ = true;
}

void RecordKeeper::run() {
  for (bool last = false; !last;) {
    Work work;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, std::chrono::nanoseconds(kRetry_ns),
                     [this] { return stop_ || !work_.lines.empty() || work_.books; });
      last = stop_;
      work = std::exchange(work_, {});
      waits_since_ns_ = clock_.monotonic_ns();
    }
    write(work);
    const std::lock_guard lock(mutex_);
    waits_since_ns_.reset();
  }
  // Nobody else is left.
  if (finished_ && journal_.is_open())
    journal_.note("stopped", "fathom-monitor ended in good order", clock_.utc_ns());
}

void RecordKeeper::write(const Work& work) {
  if (!journal_.is_open() && passed(kRetry_ns, tried_ns_)) open();
  for (const Line& line : work.lines) {
    journal_.append(line.transition, line.utc_ns);
    answered();
  }
  if (work.dropped > 0) {
    const std::string text = std::to_string(work.dropped) + " lines were dropped: the disk did not keep up.";
    journal_.note("dropped", text, clock_.utc_ns());
    log_.warning("journal " + path_ + ": " + text);
    answered();
  }
  if (!work.books) return;
  (void)outages_.write(vehicle_, *work.books);
  complain(outages_.error(), outages_trouble_);
}

void RecordKeeper::open() {
  if (path_.empty()) return;
  tried_ns_ = clock_.monotonic_ns();
  const TimeNs utc_ns = clock_.utc_ns();
  if (journal_.open(utc_ns)) {
    const auto repaired = journal_.counters().repaired_bytes;
    if (repaired > 0)
      log_.warning("journal " + path_ + ": its last line was incomplete (" + std::to_string(repaired) +
                   " bytes) and was closed");
    {
      const std::lock_guard lock(mutex_);
      latched_ = journal_.latched();
    }
    journal_.note(
        "started",
        "fathom-monitor " + std::string(runtime::version()) + ", process " + std::to_string(getpid()),
        utc_ns);
  }
  answered();
}

void RecordKeeper::answered() {
  complain(journal_.error(), journal_trouble_);
  const std::lock_guard lock(mutex_);
  state_.journal = journal_.counters();
  state_.trouble = journal_.error();
  if (waits_since_ns_) waits_since_ns_ = clock_.monotonic_ns();
}

void RecordKeeper::complain(const std::string& trouble, std::string& known) {
  if (!trouble.empty() && trouble != known) log_.error(trouble);
  known = trouble;
}

}  // namespace fathom::monitor

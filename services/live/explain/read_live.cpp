#include "live/explain/read_live.hpp"

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "base/clock.hpp"
#include "blackbox/enclosures.hpp"
#include "blackbox/queue.hpp"
#include "blackbox/store.hpp"
#include "blackbox/tap.hpp"
#include "bus/cdr.hpp"
#include "cli/command.hpp"
#include "cli/explain/read.hpp"
#include "cli/recording.hpp"
#include "runtime/build_info.hpp"

namespace fathom::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kLookForRecorder_s = 3.0;  // life signs come once a second

volatile std::sig_atomic_t stopped = 0;

/// What comes on the vehicle network, as a recorder hears it.
class Listener {
 public:
  Listener(const LiveOptions& options, const explain::History::Limits& limits)
      : history_(limits, Name(options.vehicle)),
        participant_(options.bus),
        tap_(participant_, queue_, clock_, explained_topics(), runtime::host_name(), "") {}

  /// The recording that a recorder of this host is writing; nothing as long as none is heard.
  [[nodiscard]] const std::optional<fs::path>& recording() const { return recording_; }
  [[nodiscard]] explain::History& history() { return history_; }

  void take() {
    for (blackbox::Queue::Item& item : queue_.take(kNsPerSecond / 10).items) {
      if (auto* origin = std::get_if<blackbox::Origin>(&item)) origins_.push_back(std::move(*origin));
      if (const auto* sample = std::get_if<blackbox::Sample>(&item)) take(*sample);
    }
  }

 private:
  void take(const blackbox::Sample& sample) {
    const blackbox::Origin& origin = origins_.at(sample.origin);
    add_message(history_, origin.topic, sample.bytes,
                {sample.log_ns, origin.writer, process_of_writer(origin.writer_guid)});
    if (recording_ || origin.topic != "fathom/v1/service_status") return;
    const auto status = bus::from_cdr<ServiceStatus>(sample.bytes);
    if (!status || status->host != runtime::host_name() || status->counter("files") == 0) return;
    recording_ = blackbox::recording_of(status->pid);
  }

  SystemClock clock_;
  blackbox::Queue queue_{32U << 20U};
  explain::History history_;
  std::vector<blackbox::Origin> origins_;
  std::optional<fs::path> recording_;
  bus::Participant participant_;
  blackbox::Tap tap_;  // ends first: it fills the queue
};

/// The last seconds of a recording that is being written, and of those before it in its folder.
explain::History read_recordings(const fs::path& newest, const LiveOptions& options,
                                 const explain::History::Limits& limits) {
  std::vector<fs::path> files{newest};
  std::vector<fs::path> before = blackbox::recordings_in(newest.parent_path());
  std::erase_if(before, [&](const fs::path& one) { return one >= newest; });
  std::vector<record::Reader> readers;
  TimeNs from_ns = 0;
  while (true) {
    auto reader = record::Reader::open(files.back());
    if (!reader && readers.empty()) throw Failure(ExitCode::bad_input, reader.error().message);
    if (!reader) break;
    const auto& statistics = reader.value().contents().statistics;
    if (readers.empty()) from_ns = statistics.message_end_time - from_seconds(options.last_s);
    const bool enough = statistics.message_start_time <= from_ns;
    readers.push_back(std::move(reader.value()));
    if (enough || before.empty()) break;
    files.push_back(before.back());
    before.pop_back();
  }
  explain::History history(limits, Name(options.vehicle));
  record::Selection selection;
  selection.from = from_ns;
  for (std::size_t i = readers.size(); i-- > 0;) {
    for (const std::string& problem : read_into(history, readers[i], selection))
      std::fprintf(stderr, "fathom: explain: %s: %s\n", files[i].c_str(), problem.c_str());
  }
  std::fprintf(stderr, "From %s, which is being written.\n", newest.c_str());
  return history;
}

}  // namespace

explain::History read_live(const LiveOptions& options) {
  explain::History::Limits limits;
  limits.span_ns = from_seconds(std::max(options.last_s, options.listen_s));
  stopped = 0;
  std::signal(SIGINT, [](int) { stopped = 1; });
  const SystemClock clock;
  const TimeNs start_ns = clock.monotonic_ns();
  const auto waited_s = [&] { return to_seconds(clock.monotonic_ns() - start_ns); };
  Listener listener(options, limits);
  while (stopped == 0 && !listener.recording() && waited_s() < kLookForRecorder_s) listener.take();
  if (listener.recording()) return read_recordings(*listener.recording(), options, limits);
  std::fprintf(stderr, "No recorder on this host: what comes is listened to for %g s; Ctrl-C: until now.\n",
               options.listen_s);
  while (stopped == 0 && waited_s() < options.listen_s) listener.take();
  return std::move(listener.history());
}

}  // namespace fathom::cli

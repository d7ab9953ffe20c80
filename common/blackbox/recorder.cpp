#include "blackbox/recorder.hpp"

#include <mutex>
#include <thread>
#include <utility>
#include <variant>

#include "record/recover.hpp"

namespace fathom::blackbox {

struct Recorder::Impl {
  Impl(Options options_in, const Clock& clock_in, Say say_in)
      : options(std::move(options_in)),
        clock(clock_in),
        say(std::move(say_in)),
        queue(options.queue_bytes),
        thread([this] { run(); }) {}

  ~Impl() {
    queue.end();
    thread.join();
  }

  void close_what_was_left() {
    if (options.out.extension() == ".mcap") return;
    for (const auto& path : recordings_in(options.out)) {
      const auto recovery = record::recover(path);
      if (!recovery) {
        say(true, recovery.error().message);
      } else if (!recovery.value().was_whole) {
        say(false, path.string() + ": was not closed (" + recovery.value().ending + "); closed with " +
                       std::to_string(recovery.value().messages) + " messages");
      }
    }
  }

  void run() {
    close_what_was_left();
    Store store(options, create_file, say);
    // The host's time: a disk has nothing to do with how fast the vehicle's clock runs.
    const SystemClock host;
    TimeNs settled_ns = host.monotonic_ns();
    for (bool ended = false; !ended;) {
      Queue::Batch batch = queue.take(options.sync_ns / 8);
      ended = batch.ended;
      for (Queue::Item& item : batch.items) {
        std::visit([&](auto& one) { store.add(std::move(one)); }, item);
      }
      store.add_dropped(batch.dropped);
      if (host.monotonic_ns() - settled_ns >= options.sync_ns || ended) {
        store.settle(clock.utc_ns());
        settled_ns = host.monotonic_ns();
      }
      const std::lock_guard lock(mutex);
      counts = store.counts();
    }
    store.finish();
    const std::lock_guard lock(mutex);
    counts = store.counts();
  }

  const Options options;
  const Clock& clock;
  const Say say;
  Queue queue;
  mutable std::mutex mutex;
  StoreCounts counts;
  std::thread thread;  // last: it uses everything above
};

Recorder::Recorder(Options options, const Clock& clock, Say say)
    : impl_(std::make_unique<Impl>(std::move(options), clock, std::move(say))) {}
Recorder::~Recorder() = default;

Queue& Recorder::queue() {
  return impl_->queue;
}
StoreCounts Recorder::counts() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->counts;
}

}  // namespace fathom::blackbox

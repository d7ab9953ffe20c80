#include "live/status/listener.hpp"

#include <mutex>
#include <utility>

#include "base/clock.hpp"
#include "bus/reader.hpp"
#include "status/book.hpp"

namespace fathom::cli {

struct StatusListener::Impl {
  Impl(const bus::ParticipantOptions& options, const std::string& vehicle)
      : domain(static_cast<int>(options.domain)), book(vehicle), participant(options) {
    began_ns = clock.monotonic_ns();
    listen<NavState>();
    listen<AlignmentStatus>();
    listen<MonitorStatus>();
    listen<Forecast>();
    listen<ServiceStatus>();
    listen<Alarm>();
    listen<Verdict>();
  }

  template <class T>
  void listen() {
    readers.push_back(
        std::make_shared<bus::Reader<T>>(participant, [this](const T& sample, const bus::SampleInfo&) {
          const std::lock_guard lock(mutex);
          book.add(sample, clock.monotonic_ns());
        }));
  }

  SystemClock clock;
  int domain;
  TimeNs began_ns = 0;
  mutable std::mutex mutex;  ///< guards the book
  status::StatusBook book;
  bus::Participant participant;
  std::vector<std::shared_ptr<void>> readers;  ///< last: their handlers use all of the above
};

StatusListener::StatusListener(const bus::ParticipantOptions& options, const std::string& vehicle)
    : impl_(std::make_unique<Impl>(options, vehicle)) {}

StatusListener::~StatusListener() = default;

bool StatusListener::complete() const {
  const std::lock_guard lock(impl_->mutex);
  // One life sign period after the first of both, so that every service and alarm has been heard as well.
  return to_seconds(impl_->book.heard_for_ns(impl_->clock.monotonic_ns())) > 1.2;
}

status::StatusView StatusListener::view() const {
  const std::lock_guard lock(impl_->mutex);
  const TimeNs now_ns = impl_->clock.monotonic_ns();
  status::StatusView view = impl_->book.view(now_ns);
  view.utc_ns = impl_->clock.utc_ns();
  view.domain = impl_->domain;
  view.window_s = to_seconds(now_ns - impl_->began_ns);
  return view;
}

}  // namespace fathom::cli

#include "bus/detail/workarounds/dds_log.hpp"

#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include <fastdds/dds/log/Log.hpp>

namespace fathom::bus::detail {
namespace {

using eprosima::fastdds::dds::Log;
using eprosima::fastdds::dds::LogConsumer;

// Fast DDS has one log per process, so what listens to it is one per process as well.
struct LastError {
  std::mutex mutex;
  std::string text;
  std::mutex listeners_mutex;  // held while they run; never taken while the other is held
  std::set<const std::function<void(const std::string&)>*> listeners;
};

LastError& last_error() {
  static LastError* error = new LastError;  // never destroyed: the log's thread outlives main's objects
  return *error;
}

class KeepLastError final : public LogConsumer {
 public:
  void Consume(const Log::Entry& entry) override {
    if (entry.kind != Log::Kind::Error) return;
    {
      const std::lock_guard lock(last_error().mutex);
      last_error().text = entry.message;
    }
    const std::lock_guard lock(last_error().listeners_mutex);
    for (const auto* listener : last_error().listeners) (*listener)(entry.message);
  }
};

}  // namespace

void capture_dds_log() {
  static std::once_flag once;
  std::call_once(once, [] {
    Log::SetVerbosity(Log::Kind::Error);
    Log::ClearConsumers();
    Log::RegisterConsumer(std::make_unique<KeepLastError>());
  });
}

std::string last_dds_error() {
  Log::Flush();
  const std::lock_guard lock(last_error().mutex);
  return last_error().text.empty() ? "" : " (" + last_error().text + ")";
}

DdsErrors::DdsErrors(std::function<void(const std::string&)> handler) : handler_(std::move(handler)) {
  const std::lock_guard lock(last_error().listeners_mutex);
  last_error().listeners.insert(&handler_);
}

DdsErrors::~DdsErrors() {
  const std::lock_guard lock(last_error().listeners_mutex);
  last_error().listeners.erase(&handler_);
}

}  // namespace fathom::bus::detail

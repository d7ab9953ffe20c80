#include "console/http/fan_out.hpp"

#include <algorithm>

namespace fathom::console {

Event FanOut::Client::wait(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, patience, [this] { return closed_ || !queue_.empty(); });
  if (queue_.empty()) return nullptr;
  Event event = std::move(queue_.front());
  queue_.pop_front();
  return event;
}

bool FanOut::Client::closed() const {
  const std::lock_guard lock(mutex_);
  return closed_;
}

bool FanOut::Client::put(const Event& event) {
  bool dropped = false;
  {
    const std::lock_guard lock(mutex_);
    dropped = queue_.size() >= depth_;
    if (dropped) queue_.pop_front();
    queue_.push_back(event);
  }
  changed_.notify_one();
  return dropped;
}

void FanOut::Client::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

FanOut::Join FanOut::join(const std::string& viewer) {
  const std::lock_guard lock(mutex_);
  std::erase_if(clients_, [](const auto& client) { return client.expired(); });
  if (closed_ || clients_.size() >= limits_.most_clients) return {nullptr, Refused::all_taken};
  const auto of_viewer = std::count_if(clients_.begin(), clients_.end(), [&](const auto& weak) {
    const auto client = weak.lock();
    return client && client->viewer_ == viewer;
  });
  if (static_cast<std::size_t>(of_viewer) >= limits_.most_per_viewer)
    return {nullptr, Refused::viewer_has_enough};
  std::shared_ptr<Client> client(new Client(limits_.depth, viewer));
  clients_.push_back(client);
  return {client, Refused::no};
}

void FanOut::publish(const Event& event) {
  const std::lock_guard lock(mutex_);
  for (const auto& weak : clients_) {
    if (const auto client = weak.lock()) dropped_ += client->put(event) ? 1 : 0;
  }
}

void FanOut::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  for (const auto& weak : clients_) {
    if (const auto client = weak.lock()) client->close();
  }
}

std::size_t FanOut::clients() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(
      std::count_if(clients_.begin(), clients_.end(), [](const auto& client) { return !client.expired(); }));
}

std::uint64_t FanOut::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

}  // namespace fathom::console

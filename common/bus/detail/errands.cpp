#include "bus/detail/errands.hpp"

#include <algorithm>
#include <utility>

#include "bus/detail/scheduling.hpp"

namespace fathom::bus::detail {

Errands::~Errands() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Errands::run(const void* whose, std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    const auto same = [&](const One& one) { return one.whose == whose; };
    if (std::any_of(waiting_.begin(), waiting_.end(), same)) return;
    waiting_.push_back({whose, std::move(work)});
    if (!thread_.joinable()) thread_ = std::thread([this] { this->work(); });
  }
  changed_.notify_all();
}

void Errands::forget(const void* whose) {
  std::unique_lock lock(mutex_);
  waiting_.remove_if([&](const One& one) { return one.whose == whose; });
  changed_.wait(lock, [&] { return running_ != whose; });
}

void Errands::work() {
  const ScopedChores as_chores;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
    if (ending_) return;
    const One one = std::move(waiting_.front());
    waiting_.pop_front();
    running_ = one.whose;
    lock.unlock();
    one.work();
    lock.lock();
    running_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace fathom::bus::detail

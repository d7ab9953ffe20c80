#include "bus/detail/workarounds/work_queue.hpp"

#include <algorithm>
#include <utility>

#include "bus/detail/workarounds/scheduling.hpp"

namespace fathom::bus::detail {

WorkQueue::~WorkQueue() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void WorkQueue::run(const void* whose, std::function<void()> work, int kind,
                    std::chrono::milliseconds delay) {
  {
    const std::lock_guard lock(mutex_);
    const auto same = [&](const One& one) { return one.whose == whose && one.kind == kind; };
    if (std::any_of(waiting_.begin(), waiting_.end(), same)) return;
    const auto due = std::chrono::steady_clock::now() + delay;
    const auto later = [&](const One& one) { return one.due > due; };
    waiting_.insert(std::find_if(waiting_.begin(), waiting_.end(), later),
                    {whose, kind, due, std::move(work)});
    if (!thread_.joinable()) thread_ = std::thread([this] { this->work(); });
  }
  changed_.notify_all();
}

void WorkQueue::forget(const void* whose) {
  std::unique_lock lock(mutex_);
  const auto whose_waits = [&](const One& one) { return one.whose == whose; };
  waiting_.remove_if(whose_waits);
  changed_.wait(lock, [&] { return running_ != whose; });
  waiting_.remove_if(whose_waits);  // what it asked for at its end
}

void WorkQueue::work() {
  const ScopedChores as_chores;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
    if (ending_) return;
    const auto due = waiting_.front().due;
    if (std::chrono::steady_clock::now() < due) {
      changed_.wait_until(lock, due);
      continue;
    }
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

#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

namespace fathom::bus::detail {

/// A thread for what may not be done on those of Fast DDS; begun when it is first needed. Thread-safe.
class WorkQueue {
 public:
  WorkQueue() = default;
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// Runs `work`, which must not throw, when `delay` has passed; unless one of `whose` of the same kind waits
  /// to be run already. Be quick: others wait.
  void run(const void* whose, std::function<void()> work, int kind = 0,
           std::chrono::milliseconds delay = std::chrono::milliseconds(0));
  /// Nothing of `whose` runs any more, and what waits never will. Not to be called by a task.
  void forget(const void* whose);

 private:
  void work();

  struct One {
    const void* whose;
    int kind;
    std::chrono::steady_clock::time_point due;
    std::function<void()> work;
  };
  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<One> waiting_;  // in the order of their turns
  const void* running_ = nullptr;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace fathom::bus::detail

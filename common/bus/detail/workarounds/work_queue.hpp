#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

namespace fathom::bus::detail {

/// A queue of work with a thread of its own, for what must not be done on the threads of Fast DDS. The thread
/// starts when it is first needed. Thread-safe.
class WorkQueue {
 public:
  WorkQueue() = default;
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;

  /// Runs `work` when `delay` has passed. Nothing happens when work of the same `whose` and `kind` waits
  /// already. `work` must not throw, and must be quick because other work waits.
  void run(const void* whose, std::function<void()> work, int kind = 0,
           std::chrono::milliseconds delay = std::chrono::milliseconds(0));
  /// Drops the waiting work of `whose` and waits until none of it runs. Not to be called by work itself.
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
  std::list<One> waiting_;  // in the order in which they become due
  const void* running_ = nullptr;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace fathom::bus::detail

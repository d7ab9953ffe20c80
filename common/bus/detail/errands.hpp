#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <thread>

namespace fathom::bus::detail {

/// A thread for what may not be done on those of Fast DDS; begun when it is first needed. Thread-safe.
class Errands {
 public:
  Errands() = default;
  ~Errands();
  Errands(const Errands&) = delete;
  Errands& operator=(const Errands&) = delete;

  /// Runs `work`, which must not throw, soon; unless some of `whose` waits to be run already.
  void run(const void* whose, std::function<void()> work);
  /// Nothing of `whose` runs any more, and what waits never will. Not to be called by an errand.
  void forget(const void* whose);

 private:
  void work();

  struct One {
    const void* whose;
    std::function<void()> work;
  };
  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<One> waiting_;
  const void* running_ = nullptr;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace fathom::bus::detail
